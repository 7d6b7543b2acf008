#pragma once

#include "host/bvh/cpu_traversal.hpp"
#include "host/stress/device_subject.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/support/device_fixture.hpp"

#include <vector>

namespace stromboli::test {

/// Tests of hard cases that need the device.
class HardCases : public DeviceTest {};

inline Scene sceneOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Scene scene;
    addTriangle(scene, a, b, c);
    scene.materials.resize(1);
    return scene;
}

/// Hits on the CPU and on the device, of rays that both must treat alike.
struct HitCounts {
    uint64_t cpu = 0, device = 0;
};

inline HitCounts countHits(const Scene& scene, const std::vector<stress::Ray>& rays) {
    const WideLayout layout = buildWideBvh(scene);
    HitCounts counts;
    for (const stress::Ray& r : rays) {
        TraversalRay ray;
        ray.origin = r.origin, ray.direction = r.direction, ray.tMax = r.tMax;
        counts.cpu += bool(closestHit(layout, ray));
    }
    stress::DeviceSubject device(testDevice());
    counts.device = device.tracer(scene)->countHits(rays, false);
    return counts;
}

} // namespace stromboli::test
