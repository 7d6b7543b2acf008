// Mitsuba's own test scenes, where they lie beside this project, against the pictures that come
// with them.
//
// They are judged by two rules: Mitsuba's own (host/compare/comparison.hpp), and by their means and
// those of blocks of 8 x 8 pixels (block_acceptance.hpp), of which one right picture in a thousand
// would fail.

#include "host/compare/comparison.hpp"
#include "host/film/image_formats.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"
#include "source_dir.h"
#include "tests/scene/mitsuba/references_renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;

constexpr double kFamilyError = 1e-3;

const fs::path kPeers = fs::path(STROMBOLI_SOURCE_DIR).parent_path() / "shared/peers";
const fs::path kScenes = kPeers / "mitsuba/tests/scenes";

glm::dvec3 pixelOf(FloatImage& image, size_t i) {
    return {image.channel("R")[i], image.channel("G")[i], image.channel("B")[i]};
}

struct Agreement {
    compare::Acceptance byPixels;
    compare::BlockAcceptance byBlocks;
};

/// The picture as the file asks for it.
Film filmOf(const Scene& scene, const PictureArea& area, uint32_t samples) {
    const RenderHints& hints = scene.hints;
    RenderSettings settings;
    settings.area = area;
    settings.estimator.maxBounces = hints.maxBounces.value();
    settings.estimator.filter =
        hints.filter == HintedFilter::Box ? PixelFilter::Box : PixelFilter::Gaussian;
    settings.estimator.sampler = Sampler::Independent;
    settings.estimator.conventions.offsetsTerminator = false; // Mitsuba has none
    settings.estimator.directLight = DirectLight::MisAll; // its noise is Mitsuba's, by which z goes
    settings.estimator.roulette.mode = Roulette::Mode::None;
    settings.budget.mostSamplesPerPixel = samples;
    const Camera camera = makeCamera(scene, CameraChoice::File, area.width, area.height);
    return filmWith(scene, camera, settings);
}

PictureArea areaOf(const Scene& scene) {
    return {scene.hints.width.value(), scene.hints.height.value(), {}};
}

Agreement agreement(const std::string& scene, const std::string& reference) {
    const Scene loaded = loadMitsuba(kScenes / scene);
    const PictureArea area = areaOf(loaded);
    // The reference renderer is slow, and tests/render compares its pictures with the kernel's.
    const uint32_t most = kCombinesLightSamplesWithBounces ? 2'000'000 : 1'000'000;
    const uint32_t pixels = area.width * area.height, samples = most / pixels;
    const Film film = filmOf(loaded, area, samples);
    const fs::path refs = (kScenes / scene).parent_path() / "refs";
    const compare::Picture mean = compare::readPicture(refs / (reference + "_ref_rgb.exr")),
                           variance = compare::readPicture(refs / (reference + "_ref_rgb_var.exr")),
                           picture = compare::pictureOf(film);
    if (const char* folder = std::getenv("STROMBOLI_MITSUBA_PICTURES")) {
        FloatImage image(film.width, film.height);
        for (const auto& [name, c] : {std::pair("R", 0), std::pair("G", 1), std::pair("B", 2)})
            for (const PixelStatistics& p : film.pixels)
                image.channels[name].push_back(float(p.mean[c]));
        writeExr(fs::path(folder) / (reference + ".exr"), image);
    }
    return {compare::judgeByVariance(mean, variance, picture, samples),
            compare::judgeBlocks(mean, variance, picture, samples, compare::kReferenceSamples,
                                 kFamilyError)};
}

/// shareByBounces: that of the tests of pixels which pass if light is found by bounces alone.
/// referenceIsOff: so little noise is in it that blocks of 8 x 8 see by how much it is off: Mitsuba
/// 3.9.1 fails by them as well (docs/guide/mitsuba.md).
struct Case {
    const char *scene, *reference;
    double shareByBounces = 0.9975;
    bool referenceIsOff = false;
};

class MitsubaReferences : public testing::TestWithParam<Case> {};

TEST_P(MitsubaReferences, Agree) {
    if (!fs::exists(kScenes)) GTEST_SKIP() << kScenes << " is not there";
    const Case& expected = GetParam();
    const auto [pixels, blocks] = agreement(expected.scene, expected.reference);
    std::printf("%s: %.2f %% pass, mean off by %+.3f %+.3f %+.3f %%\n", expected.scene,
                100 * pixels.share(), 100 * blocks.errors.x, 100 * blocks.errors.y,
                100 * blocks.errors.z);
    EXPECT_GE(pixels.share(),
              kCombinesLightSamplesWithBounces ? pixels.required : expected.shareByBounces);
    for (const int c : {0, 1, 2})
        EXPECT_LT(std::abs(blocks.means[c]), blocks.limit) << "X, Y, Z: " << c;
    if (!expected.referenceIsOff) {
        EXPECT_LT(blocks.largest, blocks.limit) << "block at " << blocks.x << " " << blocks.y;
    }
}

constexpr Case kCases[] = {
    {"floating_sphere/test_directional_direct.xml", "test_directional"},
    {"instancing/test_instancing_path.xml", "test_instancing"},
    {"texture_interp/test_texture_interp_direct.xml", "test_texture_interp", 0.9975, true},
    {"infinite_mirrors/scene_path.xml", "scene"},
    {"mesh_attributes/test_mesh_attributes_3_vertex_direct.xml", "test_mesh_attributes_3_vertex"},
    {"bsdf_spheres/test_pointlight_path.xml", "test_pointlight"},
    {"bsdf_spheres/test_textured_diffuse_path.xml", "test_textured_diffuse"},
    {"bsdf_spheres/test_roughdielectric_path.xml", "test_roughdielectric"},
    {"bsdf_spheres/test_envmap_path.xml", "test_envmap", 0.996},
    {"bsdf_spheres/test_roughplastic_linear_path.xml", "test_roughplastic_linear", 0.97},
    {"bsdf_spheres/test_bumpmap_path.xml", "test_bumpmap"},
    {"bsdf_spheres/test_texturedprincipled1_path.xml", "test_texturedprincipled1", 0.94},
};

INSTANTIATE_TEST_SUITE_P(Scenes, MitsubaReferences, testing::ValuesIn(kCases),
                         [](const testing::TestParamInfo<Case>& each) {
                             return std::string(each.param.reference);
                         });

/// Sums of whole pictures, each channel within 0.2 % or four standard deviations of ours.
void expectSameMean(const Film& film, const fs::path& reference, double tolerance) {
    FloatImage theirs = readExr(reference);
    const size_t theirPixels = size_t(theirs.width) * theirs.height;
    glm::dvec3 mean(0.0), expected(0.0), variance(0.0);
    for (const PixelStatistics& p : film.pixels) {
        mean += p.mean / double(film.pixels.size());
        variance += p.varianceOfMean() / std::pow(double(film.pixels.size()), 2);
    }
    for (size_t i = 0; i < theirPixels; ++i)
        expected += pixelOf(theirs, i) / double(theirPixels);
    for (const int c : {0, 1, 2}) {
        std::printf("channel %d: %.5f, expected %.5f (%+.3f %%)\n", c, mean[c], expected[c],
                    100 * (mean[c] / expected[c] - 1));
        EXPECT_NEAR(mean[c], expected[c],
                    std::max(tolerance * expected[c], 4 * std::sqrt(variance[c])));
    }
}

/// Scenes of the renderer Ignis with pictures of 4,096 samples.
TEST(IgnisReferences, MeansAgree) {
    if (!fs::exists(kPeers / "ignis"))
        GTEST_SKIP() << kPeers / "ignis"
                     << " is not there";
    for (const std::string name : {"point", "multilight"}) {
        SCOPED_TRACE(name);
        Scene scene = loadMitsuba(kPeers / "ignis/mitsuba" / (name + ".xml"));
        // Ignis takes a spectrum that is alike everywhere for grey, also that of light.
        for (Material& m : scene.materials)
            if (m.emits()) m.emission = glm::vec3(0.5f);
        expectSameMean(filmOf(scene, areaOf(scene), 16),
                       kPeers / "ignis/references" / ("ref-" + name + "-4096.exr"), 0.002);
    }
}

/// The mean of a picture as coarse as a film, whose pixels are squares of its own.
std::vector<glm::dvec3> coarse(FloatImage& image, uint32_t side) {
    const uint32_t size = image.width / side;
    std::vector<glm::dvec3> means(size_t(side) * side, glm::dvec3(0.0));
    for (size_t i = 0; i < size_t(image.width) * image.height; ++i) {
        const size_t x = i % image.width / size, y = i / image.width / size;
        means[y * side + x] += pixelOf(image, i) / (double(size) * size);
    }
    return means;
}

/// A scene of Mitsuba 0.5 with a picture by Tungsten, whose tent filter reaches a quarter of our
/// pixels' width at most. The mean is within 0.5 %; 16 x 16 tiles, of two pixels for the reference
/// renderer, within 2 %, or 4.5 standard deviations of ours.
TEST(RainbowReferences, MeansAndTilesAgree) {
    const fs::path folder = kPeers / "rainbow/cornell-box";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    Scene scene = loadMitsuba(folder / "scene.xml");
    scene.hints.filter = HintedFilter::Box;
    const uint32_t side = kCombinesLightSamplesWithBounces ? 256 : 32;
    const Film film = filmOf(scene, {side, side, {}}, kCombinesLightSamplesWithBounces ? 128 : 512);
    expectSameMean(film, folder / "TungstenRender.exr", 0.005);

    FloatImage image = readExr(folder / "TungstenRender.exr");
    const std::vector<glm::dvec3> theirs = coarse(image, side);
    constexpr uint32_t kTiles = 16;
    const uint32_t size = side / kTiles;
    for (uint32_t tile = 0; tile < kTiles * kTiles; ++tile) {
        glm::dvec3 difference(0.0), expected(0.0), variance(0.0);
        for (uint32_t i = 0; i < size * size; ++i) {
            const size_t x = tile % kTiles * size + i % size, y = tile / kTiles * size + i / size;
            const PixelStatistics& p = film.pixels[y * side + x];
            difference += p.mean - theirs[y * side + x];
            expected += theirs[y * side + x];
            variance += p.varianceOfMean();
        }
        for (const int c : {0, 1, 2})
            EXPECT_NEAR(difference[c], 0,
                        std::max(0.02 * expected[c], 4.5 * std::sqrt(variance[c])))
                << "tile " << tile % kTiles << " " << tile / kTiles << ", channel " << c;
    }
}

/// The t-tests of the course renderer Nori, restated as Mitsuba scenes: the mean of some pixels
/// that look at one point, 4 standard errors. Theirs is at the significance 0.01, with as many
/// samples. Those of a single pixel would be taken one after the other.
double noriMean(const std::string& inside, double reference) {
    const fs::path file = fs::path(testing::TempDir()) / "nori_restated.xml";
    std::ofstream(file)
        << "<scene version=\"3.0.0\"><path value=\"" << (kPeers / "nori/pa5/tests").string()
        << "\"/><integrator type=\"path\"><integer name=\"max_depth\" value=\"65\"/></integrator>"
        << inside << "</scene>";
    PixelStatistics pixel;
    for (const PixelStatistics& p : filmOf(loadMitsuba(file), {16, 16, {}}, 80).pixels)
        pixel.merge(p);
    EXPECT_NEAR(pixel.mean.y, reference, 4 * std::sqrt(pixel.varianceOfMean().y) + 1e-6);
    return pixel.mean.y;
}

std::string noriSensor(const std::string& place, const std::string& fov) {
    return "<sensor type=\"perspective\"><transform name=\"to_world\">" + place +
           "</transform><float name=\"fov\" value=\"" + fov +
           "\"/><film type=\"hdrfilm\"><rfilter type=\"box\"/><integer name=\"width\" value=\"1\"/>"
           "<integer name=\"height\" value=\"1\"/></film></sensor>";
}

std::string noriMesh(const std::string& file, double albedo, bool shines) {
    const std::string light =
        "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter>";
    return "<shape type=\"obj\"><string name=\"filename\" value=\"" + file +
           "\"/><boolean name=\"face_normals\" value=\"true\"/><bsdf type=\"diffuse\"><rgb "
           "name=\"reflectance\" value=\"" +
           std::to_string(albedo) + "\"/></bsdf>" + (shines ? light : "") + "</shape>";
}

TEST(NoriReferences, DirectLightOfPolygons) {
    if (!fs::exists(kPeers / "nori"))
        GTEST_SKIP() << kPeers / "nori"
                     << " is not there";
    const double references[] = {0.0898394, 0.02292, 0.0534198, 0.0205314, 0.26174};
    for (int i = 0; i < 5; ++i) {
        SCOPED_TRACE(i + 1);
        noriMean(noriSensor("<lookat origin=\"0, 0.01, 0\" target=\"0, 0, 0\" up=\"0, 0, 1\"/>",
                            "0.000001") +
                     noriMesh("floor.obj", 0.5, false) +
                     noriMesh("polylum" + std::to_string(i + 1) + ".obj", 0, true),
                 references[i]);
    }
}

/// Inside of a box of radiance 1 and albedo a: 1 / (1 - a).
TEST(NoriReferences, Furnaces) {
    if (!fs::exists(kPeers / "nori"))
        GTEST_SKIP() << kPeers / "nori"
                     << " is not there";
    for (const double albedo : {0.5, 0.8}) {
        SCOPED_TRACE(albedo);
        noriMean(noriSensor("<scale value=\"1\"/>", "10") + noriMesh("furnace.obj", albedo, true),
                 1 / (1 - albedo));
    }
}

} // namespace
} // namespace stromboli::test
