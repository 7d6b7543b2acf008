// What is measured of whole paths and of growing scenes; nothing is timed.
#include "host/bench/path_bench.hpp"
#include "host/bench/ray_bench.hpp"
#include "tests/bench/bench_fixtures.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli::bench {
namespace {

using test::DeviceTest;
using test::testDevice;

AlternatePlan shortPlan() {
    AlternatePlan plan;
    plan.repeats = 1;
    plan.leastSeconds = 0;
    return plan;
}

/// A scene of the library and all that benchmarks of it need.
struct Bench {
    OpenedEmbree embree = openEmbree(2);
    BenchScene scene;
    RenderSettings settings;
    Arena arena;

    explicit Bench(const std::string& name)
        : scene(loadBenchScene(name)),
          settings(small()), arena{testDevice(), embree.embree.get(),       2,       shortPlan(),
                                   scene,        cameraOf(scene, settings), settings} {}

    static RenderSettings small() {
        RenderSettings s;
        s.area.width = s.area.height = 48;
        s.budget.mostSamplesPerPixel = 4;
        s.estimator.maxBounces = 5;
        s.estimator.gapProposal = false; // as `bench` has it
        return s;
    }
    GpuScene gpu() const {
        return packScene(scene.scene, buildWideBvh(scene.scene),
                         lightSelection(settings.estimator));
    }
};

TEST_F(DeviceTest, PathsAreThoseOfTheKernel) {
    const Bench bench("cornell_boxes");
    const PathReport report = benchPaths(bench.arena, bench.gpu());
    EXPECT_GT(report.raysPerPath, 1);
    EXPECT_GT(report.lanesBusy, 0);
    EXPECT_LE(report.lanesBusy, 1);
    ASSERT_EQ(report.contestants.size(), 1u);
    EXPECT_EQ(report.contestants[0].wallSeconds.size(), 1u);
}

TEST_F(DeviceTest, VariantsMakeTheSamePictureToTheBit) {
    const Bench bench("cornell_boxes");
    const VariantReport report =
        benchVariants(bench.arena, bench.gpu(), kernelVariants(bench.gpu()));
    ASSERT_EQ(report.samePicture.size() + 1, report.contestants.size());
    for (const bool same : report.samePicture)
        EXPECT_TRUE(same);
}

TEST_F(DeviceTest, GrowingSceneHasTheSizeItSays) {
    const OpenedEmbree embree = openEmbree(2);
    const GrowthPoint point =
        benchSize(2000, testDevice(), embree.embree.get(), 2, Bench::small(), 1, shortPlan());
    EXPECT_NEAR(double(point.triangles), 2000, 20); // to within 1 %
    EXPECT_GT(point.bounce.rays, 0u);
    for (const uint64_t count : point.bounce.disagreements)
        EXPECT_LE(count, point.bounce.rays / 100);
}

} // namespace
} // namespace stromboli::bench
