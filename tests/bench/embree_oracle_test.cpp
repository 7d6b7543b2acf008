// Embree as an independent oracle for hard rays: soups, needles of closed meshes, rays at their
// edges and corners. Where it and the kernel disagree, trying every primitive in double precision
// says who is right.
#include "host/bench/device_rays.hpp"
#include "host/bench/embree.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/stress/oracle.hpp"
#include "scene/generate/hard_meshes.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stromboli::bench {
namespace {

using test::DeviceTest;
using test::testDevice;

const Embree& embree() {
    static const OpenedEmbree opened = openEmbree(2);
    if (!opened.embree) throw std::runtime_error("no Embree: " + opened.missing);
    return *opened.embree;
}

std::vector<float> onDevice(const Scene& scene, const RaySet& set) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene));
    DeviceRays rays(testDevice(), gpu, rayTuning(testDevice()));
    rays.load(set);
    return rays.distances();
}

struct Verdict {
    uint64_t disagreements = 0;
    uint64_t wrong = 0; ///< of those: not the closest hit as far as can be said
};

Verdict judge(const Scene& scene, const RaySet& set, double error) {
    const auto built =
        embree().build(embree().geometry(scene), EmbreeMode::Robust, EmbreeQuality::High);
    const std::vector<float> theirs = built->distances(set), ours = onDevice(scene, set);
    Verdict verdict;
    for (size_t i = 0; i < set.rays.size(); ++i) {
        const RaySet one{"one", false, {set.rays[i]}};
        if (countDisagreements(one, {ours[i]}, {theirs[i]}) == 0) continue;
        ++verdict.disagreements;
        verdict.wrong += !stress::isClosestHit(scene, set.rays[i], ours[i], error);
    }
    return verdict;
}

/// Rays at corners and edges of the mesh, through it, from inside and outside.
RaySet raysAt(const Scene& mesh, uint32_t count, Random& random) {
    RaySet set{"hard", false, {}};
    for (uint32_t i = 0; i < count; ++i) {
        const Triangle& t = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))];
        const glm::vec3 a = mesh.positions[t.corner[0]], b = mesh.positions[t.corner[1]];
        const glm::vec3 target = i % 3 == 0 ? a : a + random.uniform() * (b - a);
        const glm::vec3 origin = random.inCube(i % 2 ? 0.1f : 4.0f);
        set.rays.push_back({origin, stress::kMissed, target - origin, 0});
    }
    return set;
}

TEST_F(DeviceTest, EmbreeFindsTheSameHitsOrIsWrong) {
    Random random(17);
    // Coordinates stay below 8 and carry some 20 roundings (stress: soups).
    constexpr double kError = 8 * 20 * 0x1p-24;
    for (const Scene& scene :
         {soup(1500, 0, 0.2f, random), starMesh(2, random), starMesh(5, random)}) {
        const RaySet set = raysAt(scene, 20000, random);
        const Verdict verdict = judge(scene, set, kError);
        EXPECT_EQ(verdict.wrong, 0u) << verdict.disagreements << " disagreements";
        // At an edge that is a silhouette either answer is right: some of a third of the rays.
        EXPECT_LT(verdict.disagreements, set.rays.size() / 3);
    }
}

/// Negative control: a triangle is missing on the device.
TEST_F(DeviceTest, EmbreeFindsAMissingTriangle) {
    Random random(18);
    Scene scene = starMesh(2, random);
    const RaySet set = raysAt(scene, 20000, random);
    const auto built =
        embree().build(embree().geometry(scene), EmbreeMode::Robust, EmbreeQuality::High);
    const uint64_t before = countDisagreements(set, onDevice(scene, set), built->distances(set));
    scene.triangles.pop_back();
    EXPECT_GT(countDisagreements(set, onDevice(scene, set), built->distances(set)), before + 50);
}

} // namespace
} // namespace stromboli::bench
