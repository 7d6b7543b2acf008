// What branches are for: less noise for the rays that are traced, where bounces make the noise.
#include "host/render/sampling_session.hpp"
#include "host/render/settings.hpp"
#include "scene/read_scene.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

Scene libraryScene(const std::string& name) {
    return loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library" /
                     (name + ".dae"));
}

class BranchesGain : public DeviceTest {
  protected:
    static double relativeDifference(const Film& a, const Film& b) {
        glm::dvec3 mean(0.0), sum(0.0);
        for (const PixelStatistics& p : a.pixels)
            mean += p.mean / double(a.pixels.size());
        for (size_t i = 0; i < a.pixels.size(); ++i) {
            const glm::dvec3 middle = 0.5 * (a.pixels[i].mean + b.pixels[i].mean);
            const glm::dvec3 d = a.pixels[i].mean - b.pixels[i].mean;
            sum += d * d / (middle * middle + 0.01 * mean * mean);
        }
        return (sum.x + sum.y + sum.z) / 3 / double(a.pixels.size());
    }

    /// Variance of 64 paths a pixel, from the differences of pictures of independent noise.
    static Expense expense(const Scene& scene, uint32_t branches, uint32_t maxBounces = 5) {
        RenderSettings s;
        s.area.width = 64, s.area.height = 48;
        s.budget.mostSamplesPerPixel = 64 / branches;
        s.estimator.branches = branches;
        s.estimator.gapProposal = false; // which takes noise away from bounces
        s.estimator.maxBounces = maxBounces;
        const GpuScene gpu = packScene(scene, buildWideBvh(scene));
        const Camera camera =
            makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
        Expense result;
        constexpr uint32_t kPairs = 4; // a lamp's edge in one of them is a tenth of its difference
        for (s.estimator.seed = 0; s.estimator.seed < 2 * kPairs; ++s.estimator.seed) {
            VulkanBackend first(testDevice(), gpu, camera, s);
            const Film a = render(first, s);
            ++s.estimator.seed;
            VulkanBackend second(testDevice(), gpu, camera, s);
            result.variance += relativeDifference(a, render(second, s)) / (2 * kPairs);
            result.rays += double(first.counters().rays) / kPairs;
        }
        return result;
    }
};

TEST_F(BranchesGain, LessNoisePerRayWhereTheyAreUsed) {
    // Variance times CPU time, by hand at 240 x 180 with 128 paths: 1.2, 1.2 and 1.7 times less.
    for (const char* name : {"cornell_boxes", "cornell_spheres", "light_spot"}) {
        const Scene scene = libraryScene(name);
        const uint32_t branches = branchesThatPay(scene, {}, {});
        ASSERT_EQ(branches, 4u) << name;
        const Expense split = expense(scene, branches), whole = expense(scene, 1);
        // What is shared is traced once for all branches, and they are no shorter than whole paths:
        // roulette does not end a branch the sooner for being one of four.
        const double shared = expense(scene, 1, 1).rays;
        EXPECT_NEAR(split.rays, shared / branches + whole.rays - shared, 0.02 * whole.rays) << name;
        EXPECT_LT(split.variance * split.rays, 0.95 * whole.variance * whole.rays) << name;
    }
}

TEST_F(BranchesGain, NotUsedWhereTheyDoNotPay) {
    for (const char* name : {"island", "light_ambient"})
        EXPECT_EQ(branchesThatPay(libraryScene(name), {}, {}), 1u) << name;
    EXPECT_EQ(branchesThatPay(readScene("generate:lamps:1000"), {}, {}), 1u);
    const Scene sky = libraryScene("light_ambient");
    const Expense split = expense(sky, 4), whole = expense(sky, 1);
    EXPECT_GT(split.variance * split.rays, whole.variance * whole.rays);
}

TEST(BranchesThatPay, LeavesSamplesForEdges) {
    const Scene boxes = libraryScene("cornell_boxes");
    for (const auto& [paths, branches] : {std::pair(1u, 1u),
                                          {8u, 1u},
                                          {15u, 1u},
                                          {16u, 2u},
                                          {24u, 2u},
                                          {31u, 1u},
                                          {32u, 2u},
                                          {34u, 2u},
                                          {63u, 1u},
                                          {64u, 4u},
                                          {1u << 24, 4u}})
        EXPECT_EQ(branchesThatPay(boxes, {}, {.mostPathsPerPixel = paths}), branches) << paths;
}

TEST(BranchesThatPay, OnlyWhereSomethingBouncesAfterDirectLight) {
    const Scene boxes = libraryScene("cornell_boxes");
    const auto with = [&](void (*change)(Estimator&), const PathBudget& budget = {}) {
        Estimator estimator;
        change(estimator);
        return branchesThatPay(boxes, estimator, budget);
    };
    EXPECT_EQ(with([](Estimator& e) { e.maxBounces = 1; }), 1u);
    EXPECT_EQ(with([](Estimator& e) { e.maxBounces = 2; }), 4u);
    EXPECT_EQ(with([](Estimator& e) { e.integrator = Integrator::Normals; }), 1u);
    EXPECT_EQ(with([](Estimator& e) { e.filter = PixelFilter::Lanczos; }), 1u);
    EXPECT_EQ(with([](Estimator& e) { e.directLight = DirectLight::Hemisphere; }), 1u);
    EXPECT_EQ(with([](Estimator& e) { e.directLight = DirectLight::Bsdf; }), 1u);
    EXPECT_EQ(with([](Estimator&) {}, {.adaptive = {.enabled = true}}), 1u);
}

} // namespace
} // namespace stromboli
