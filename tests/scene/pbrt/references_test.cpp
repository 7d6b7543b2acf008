// Public scenes with reference pictures, where they lie beside this project, retold in pbrt's
// words: whatever pbrt has other conventions for (the camera's hand, angles, textures upside down,
// maps of all around) would show. Agreement by means, and by blocks or tiles within the noise.

#include "host/compare/comparison.hpp"
#include "host/film/image_formats.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"
#include "source_dir.h"
#include "tests/scene/mitsuba/references_renderer.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"
#include "tests/scene/pbrt/retold_scene.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;

const fs::path kPeers = fs::path(STROMBOLI_SOURCE_DIR).parent_path() / "shared/peers";

Scene retoldScene(const fs::path& file, pbrt::Version version) {
    SceneConventions conventions;
    conventions.instances = InstanceSharing::Off;
    return loadText(retold(loadMitsuba(file, conventions), version), true);
}

Film filmOf(const Scene& scene, const PictureArea& area, uint32_t samples) {
    RenderSettings settings;
    settings.area = area;
    settings.estimator.maxBounces = scene.hints.maxBounces.value();
    settings.estimator.filter = PixelFilter::Box;
    settings.estimator.sampler = Sampler::Independent;
    settings.estimator.conventions.offsetsTerminator = false;
    settings.estimator.directLight = DirectLight::MisAll;
    settings.estimator.roulette.mode = Roulette::Mode::None;
    settings.budget.mostSamplesPerPixel = samples;
    return filmWith(scene, makeCamera(scene, CameraChoice::File, area.width, area.height),
                    settings);
}

/// Mitsuba's own scenes and pictures, which come with their variances.
void expectMitsubas(const std::string& scene, const std::string& reference, pbrt::Version version) {
    const fs::path file = kPeers / "mitsuba/tests/scenes" / scene;
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene loaded = retoldScene(file, version);
    constexpr uint32_t kSamples = 128;
    const Film film =
        filmOf(loaded, {loaded.hints.width.value(), loaded.hints.height.value(), {}}, kSamples);
    const fs::path refs = file.parent_path() / "refs";
    const compare::Picture mean = compare::readPicture(refs / (reference + "_ref_rgb.exr")),
                           variance = compare::readPicture(refs / (reference + "_ref_rgb_var.exr")),
                           picture = compare::pictureOf(film);
    const compare::Acceptance pixels = compare::judgeByVariance(mean, variance, picture, kSamples);
    const compare::BlockAcceptance blocks =
        compare::judgeBlocks(mean, variance, picture, kSamples, compare::kReferenceSamples, 1e-3);
    std::printf("%s: %.2f %% pass, mean off by %+.3f %+.3f %+.3f %%\n", scene.c_str(),
                100 * pixels.share(), 100 * blocks.errors.x, 100 * blocks.errors.y,
                100 * blocks.errors.z);
    EXPECT_GE(pixels.share(), pixels.required);
    EXPECT_LT(blocks.largest, blocks.limit) << "block at " << blocks.x << " " << blocks.y;
    for (const int c : {0, 1, 2}) {
        EXPECT_LT(std::abs(blocks.means[c]), blocks.limit) << "X, Y, Z: " << c;
        EXPECT_LT(std::abs(blocks.errors[c]), 5e-3) << "X, Y, Z: " << c;
    }
}

TEST(PbrtReferences, ADirectionalLightAgreesWithMitsuba) {
    expectMitsubas("floating_sphere/test_directional_direct.xml", "test_directional",
                   pbrt::Version::V4);
}

TEST(PbrtReferences, ATextureUnderThreeLightsAgreesWithMitsuba) {
    expectMitsubas("bsdf_spheres/test_textured_diffuse_path.xml", "test_textured_diffuse",
                   pbrt::Version::V3);
}

/// The mean of a square of a picture.
glm::dvec3 meanOf(const FloatImage& image, uint32_t left, uint32_t top, uint32_t side) {
    glm::dvec3 sum(0.0);
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const std::vector<float>& values = image.channels.at(names[c]);
        for (uint32_t y = top; y < top + side; ++y)
            for (uint32_t x = left; x < left + side; ++x)
                sum[c] += double(values[size_t(y) * image.width + x]);
    }
    return sum / (double(side) * side);
}

/// Bitterli's room with Tungsten's picture, whose tent filter reaches a few of our pixels. The mean
/// is within 0.5 %, or four standard deviations of ours; 8 x 8 tiles within 2 %, or 4.5 of them.
TEST(PbrtReferences, TheCornellBoxAgreesWithTungsten) {
    const fs::path folder = kPeers / "rainbow/cornell-box";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    const Scene scene = retoldScene(folder / "scene.xml", pbrt::Version::V4);
    constexpr uint32_t kSide = 64, kTiles = 8, kTile = kSide / kTiles;
    const Film film = filmOf(scene, {kSide, kSide, {}}, 96);
    const FloatImage theirs = readExr(folder / "TungstenRender.exr");
    const uint32_t scale = theirs.width / kSide;
    glm::dvec3 mean(0.0), variance(0.0);
    for (uint32_t tile = 0; tile < kTiles * kTiles; ++tile) {
        const uint32_t left = tile % kTiles * kTile, top = tile / kTiles * kTile;
        glm::dvec3 ours(0.0), noise(0.0);
        for (uint32_t i = 0; i < kTile * kTile; ++i) {
            const PixelStatistics& p =
                film.pixels[size_t(top + i / kTile) * kSide + left + i % kTile];
            ours += p.mean / double(kTile * kTile);
            noise += p.varianceOfMean() / std::pow(double(kTile * kTile), 2);
        }
        const glm::dvec3 expected = meanOf(theirs, left * scale, top * scale, kTile * scale);
        for (const int c : {0, 1, 2})
            EXPECT_NEAR(ours[c], expected[c],
                        std::max(0.02 * expected[c], 4.5 * std::sqrt(noise[c])))
                << "tile " << tile << ", channel " << c;
        mean += ours / double(kTiles * kTiles);
        variance += noise / std::pow(double(kTiles * kTiles), 2);
    }
    const glm::dvec3 expected = meanOf(theirs, 0, 0, theirs.width);
    for (const int c : {0, 1, 2}) {
        std::printf("channel %d: %.5f, expected %.5f (%+.3f %%, noise %.3f %%)\n", c, mean[c],
                    expected[c], 100 * (mean[c] / expected[c] - 1),
                    100 * std::sqrt(variance[c]) / expected[c]);
        EXPECT_NEAR(mean[c], expected[c],
                    std::max(0.005 * expected[c], 4 * std::sqrt(variance[c])));
    }
}

} // namespace
} // namespace stromboli::test
