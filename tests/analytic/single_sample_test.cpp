// A sample taken on its own is, to the last bit, the one that a whole picture has.
#include "scene/collada/load_collada.hpp"
#include "source_dir.h"
#include "tests/analytic/scenes.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace stromboli {
namespace {

using namespace test;

const std::filesystem::path kLibrary =
    std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library";

RenderSettings picture() {
    RenderSettings s;
    s.area.width = 24, s.area.height = 18;
    s.budget.mostSamplesPerPixel = 20; // more than the first pass of a render
    s.estimator.lightSamples = 2;
    s.estimator.seed = 7;
    return s;
}

class SingleSample : public testing::TestWithParam<const char*> {};

TEST_P(SingleSample, IsTheSameAsInTheRun) {
    const Scene scene = loadCollada(kLibrary / GetParam(), {});
    const RenderSettings settings = picture();
    const Camera camera =
        makeCamera(scene, CameraChoice::Automatic, settings.area.width, settings.area.height);
    const Film film = renderFilm(scene, camera, settings);
    int different = 0;
    for (const uint32_t pixel : {101u, 200u, 233u, 276u, 370u}) {
        const auto samples =
            samplesAlone(scene, camera, settings, pixel, settings.budget.mostSamplesPerPixel);
        for (const SampleValue& s : samples)
            different += s.radiance != samples.front().radiance;
        const glm::dvec3 mean = meanInOrder(samples);
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(mean[c], film.pixels[pixel].mean[c]) << "pixel " << pixel << ' ' << c;
    }
    EXPECT_GT(different, 40) << "the pixels are too plain to tell samples apart";
}

INSTANTIATE_TEST_SUITE_P(Library, SingleSample,
                         testing::Values("cornell_mirror_glass.dae", "cornell_metal.dae",
                                         "cornell_mesh.dae", "light_ambient.dae", "light_spot.dae"),
                         test::NamedByValue{});

/// A sphere of infinite radiance reaches into the middle pixel.
TEST(RejectedSample, IsFoundAgainByItsNumber) {
    SceneMaker b;
    b.sphere({0.5f, 0, 0}, 0.5f, b.add(emissive(std::numeric_limits<float>::infinity())));
    b.sphere({-0.5f, 0, 0}, 0.5f, b.add(emissive(3)));
    RenderSettings s = smallPicture(24, 0);
    s.area.width = s.area.height = 3;
    const Camera camera = pointCamera({0, 0, 3}, {0, 0, 0}, 0.1);
    const Film film = renderFilm(b.scene, camera, s);
    const PixelStatistics& middle = film.at(1, 1);
    ASSERT_GT(middle.rejected, 0u);
    ASSERT_GT(middle.count, 0u);
    EXPECT_EQ(film.at(0, 1).rejected, 0u) << "a neighbour";

    const auto samples = samplesAlone(b.scene, camera, s, 4, s.budget.mostSamplesPerPixel);
    uint32_t rejected = 0;
    for (uint32_t i = 0; i < samples.size(); ++i) {
        rejected += samples[i].rejected;
        EXPECT_EQ(samples[i].rejected, !std::isfinite(samples[i].radiance.x)) << i;
        EXPECT_FALSE(samples[i].rejected && i < middle.firstRejected) << i;
    }
    EXPECT_EQ(rejected, middle.rejected);
    EXPECT_TRUE(samples[middle.firstRejected].rejected);
}

} // namespace
} // namespace stromboli
