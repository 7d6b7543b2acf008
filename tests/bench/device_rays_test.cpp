// The ray kernel against the reference's traversal in double precision.
#include "host/bench/device_rays.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/core/error.hpp"
#include "host/reference/bvh.hpp"
#include "tests/bench/bench_fixtures.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace stromboli::bench {
namespace {

using test::DeviceTest;
using test::libraryPicture;
using test::LibraryPicture;
using test::testDevice;

constexpr float kMiss = std::numeric_limits<float>::max();

std::vector<float> expectedDistances(const Scene& scene, const RaySet& set) {
    const reference::Bvh bvh(scene);
    std::vector<float> distances;
    for (const gpu::TracedRay& ray : set.rays) {
        // The reference wants unit directions.
        const double length = glm::length(glm::dvec3(ray.direction));
        const reference::Ray unit{ray.origin, glm::dvec3(ray.direction) / length, 0,
                                  double(ray.tMax) * length};
        const reference::Hit hit = bvh.closest(unit, {});
        const bool missed = hit.primitive == reference::kNoPrimitive;
        distances.push_back(missed ? kMiss : float(hit.t / length));
    }
    return distances;
}

struct Traced {
    std::vector<float> distances;
    RayTotals totals;
};

Traced traceOnDevice(const Scene& scene, const RaySet& set, const RayTuning& tuning) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene));
    DeviceRays device(testDevice(), gpu, tuning);
    device.load(set);
    return {device.distances(), device.trace()};
}

RayTuning tuningWith(uint32_t raysPerLane, bool texelFetch = true, uint32_t steps = 1) {
    RayTuning t = rayTuning(testDevice());
    t.raysPerLane = raysPerLane;
    t.kernel.texelFetch = texelFetch;
    t.kernel.traversalSteps = steps;
    return t;
}

class DeviceRaysIn : public DeviceTest, public testing::WithParamInterface<const char*> {};

/// Rays through an edge or a corner may go either way: 1 in 500.
TEST_P(DeviceRaysIn, EndWhereTheReferenceSays) {
    const LibraryPicture picture = libraryPicture(GetParam());
    const RaySets sets = makeRaySets(picture.scene, picture.camera, picture.settings, 2);
    for (const RaySet* set : {&sets.camera, &sets.shadow, &sets.bounce}) {
        const Traced traced = traceOnDevice(picture.scene, *set, rayTuning(testDevice()));
        const std::vector<float> expected = expectedDistances(picture.scene, *set);
        EXPECT_LE(countDisagreements(*set, traced.distances, expected), set->rays.size() / 500)
            << set->name;
        size_t hits = 0;
        double sum = 0;
        for (const float t : traced.distances)
            if (t < kMiss) ++hits, sum += double(t);
        EXPECT_EQ(traced.totals.hits, hits) << set->name;
        // Lanes add up in float.
        if (set->anyHit) continue; // any hit will do
        EXPECT_NEAR(traced.totals.distances, sum, 1e-4 * sum) << set->name;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeviceRaysIn,
                         testing::Values("cornell_boxes", "cornell_spheres", "cornell_mesh"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(DeviceTest, RayKernelIsTheSameHoweverItRuns) {
    const LibraryPicture picture = libraryPicture("cornell_boxes");
    const RaySet set = makeRaySets(picture.scene, picture.camera, picture.settings, 1).bounce;
    const std::vector<float> expected = traceOnDevice(picture.scene, set, tuningWith(1)).distances;
    EXPECT_EQ(traceOnDevice(picture.scene, set, tuningWith(7)).distances, expected);
    EXPECT_EQ(traceOnDevice(picture.scene, set, tuningWith(64, true, 8)).distances, expected);
    EXPECT_EQ(traceOnDevice(picture.scene, set, tuningWith(16, false)).distances, expected);
}

/// llvmpipe ends loops silently after 65,535 passes; with this many rays a lane meets the limit.
TEST_F(DeviceTest, RayKernelOwnsUpToALoopLimit) {
    if (!testDevice().description().isCpu()) GTEST_SKIP() << "only llvmpipe has the limit";
    const LibraryPicture picture = libraryPicture("cornell_boxes");
    RaySet set = makeRaySets(picture.scene, picture.camera, picture.settings, 1).camera;
    constexpr uint32_t kRaysPerLane = 1 << 13; // of some steps each
    set.rays.resize(kRaysPerLane * rayTuning(testDevice()).kernel.workgroupSize,
                    set.rays[set.rays.size() / 2]);
    const GpuScene gpu = packScene(picture.scene, buildWideBvh(picture.scene));
    DeviceRays device(testDevice(), gpu, tuningWith(kRaysPerLane));
    device.load(set);
    EXPECT_THROW(device.trace(), DeviceError);
}

TEST(CountDisagreements, HitsMissesAndDistances) {
    RaySet set;
    set.rays.resize(5);
    const std::vector<float> a = {1, 1, kMiss, kMiss, 1};
    const std::vector<float> b = {1 + 0x1p-16f, 1.01f, kMiss, 1, kMiss};
    EXPECT_EQ(countDisagreements(set, a, b), 3u);
    set.anyHit = true; // whatever is hit, it is hit
    EXPECT_EQ(countDisagreements(set, a, b), 2u);
}

} // namespace
} // namespace stromboli::bench
