// Mitsuba's own test scenes, where they lie beside this project, against the pictures that come
// with them.
//
// Each pixel and channel in XYZ is a two-sided z-test at 1 - 0.99^(1 / pixels); 99.75 % of them
// must pass, as in Mitsuba's tests, and the mean must agree within 0.5 %, or four standard
// deviations where noise is more. The references' own noise, of some 32,000 samples, adds to ours.

#include "host/film/exr.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"
#include "tests/scene/mitsuba/references_renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;

const fs::path kPeers = fs::path(STROMBOLI_SOURCE_DIR).parent_path() / "shared/peers";
const fs::path kScenes = kPeers / "mitsuba/tests/scenes";

/// IEC 61966-2-1; columns.
const glm::dmat3 kXyzFromRgb(0.412453, 0.212671, 0.019334, 0.357580, 0.715160, 0.119193, 0.180423,
                             0.072169, 0.950227);

glm::dvec3 pixelOf(FloatImage& image, size_t i) {
    return {image.channel("R")[i], image.channel("G")[i], image.channel("B")[i]};
}

/// The z above which a two-sided test at `level` fails.
double criticalZ(double level) {
    double low = 0, high = 40;
    for (int i = 0; i < 100; ++i) {
        const double z = 0.5 * (low + high);
        (std::erfc(z / std::sqrt(2.0)) > level ? low : high) = z;
    }
    return low;
}

struct Agreement {
    double passed = 0;      ///< share of the tests
    glm::dvec3 meanError{}; ///< relative, of red, green and blue
    glm::dvec3 meanNoise{}; ///< its standard deviation
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
    const uint32_t pixels = area.width * area.height, samples = 2'000'000 / pixels;
    const Film film = filmOf(loaded, area, samples);
    const fs::path refs = (kScenes / scene).parent_path() / "refs";
    FloatImage mean = readExr(refs / (reference + "_ref_rgb.exr"));
    FloatImage variance = readExr(refs / (reference + "_ref_rgb_var.exr"));
    const double critical = criticalZ(1 - std::pow(0.99, 1.0 / pixels));
    size_t passed = 0;
    glm::dvec3 ours(0.0), theirs(0.0), noise(0.0);
    for (uint32_t i = 0; i < pixels; ++i) {
        const glm::dvec3 difference = kXyzFromRgb * (film.pixels[i].mean - pixelOf(mean, i));
        const glm::dvec3 spread = kXyzFromRgb * pixelOf(variance, i);
        for (const int c : {0, 1, 2}) {
            const double z =
                std::abs(difference[c]) * std::sqrt(samples / std::max(spread[c], 1e-4));
            passed += z < critical ? 1 : 0;
        }
        ours += film.pixels[i].mean;
        theirs += pixelOf(mean, i);
        noise += film.pixels[i].varianceOfMean();
    }
    if (const char* folder = std::getenv("STROMBOLI_MITSUBA_PICTURES")) {
        FloatImage picture(film.width, film.height);
        for (const auto& [name, c] : {std::pair("R", 0), std::pair("G", 1), std::pair("B", 2)})
            for (const PixelStatistics& p : film.pixels)
                picture.channels[name].push_back(float(p.mean[c]));
        writeExr(fs::path(folder) / (reference + ".exr"), picture);
    }
    return {double(passed) / (3.0 * pixels), (ours - theirs) / theirs, glm::sqrt(noise) / theirs};
}

/// shareByBounces: that of the tests which pass if light is found by bounces alone.
struct Case {
    const char *scene, *reference;
    double shareByBounces = 0.9975;
    double leastShare = 0.9975, mostMeanError = 0.005;
};

class MitsubaReferences : public testing::TestWithParam<Case> {};

TEST_P(MitsubaReferences, Agree) {
    if (!fs::exists(kScenes)) GTEST_SKIP() << kScenes << " is not there";
    const Case& expected = GetParam();
    const Agreement found = agreement(expected.scene, expected.reference);
    std::printf("%s: %.2f %% pass, mean off by %+.3f %+.3f %+.3f %%\n", expected.scene,
                100 * found.passed, 100 * found.meanError.x, 100 * found.meanError.y,
                100 * found.meanError.z);
    EXPECT_GE(found.passed,
              kCombinesLightSamplesWithBounces ? expected.leastShare : expected.shareByBounces);
    for (const int c : {0, 1, 2})
        EXPECT_NEAR(found.meanError[c], 0,
                    std::max(expected.mostMeanError, 4 * found.meanNoise[c]));
}

constexpr Case kCases[] = {
    {"floating_sphere/test_directional_direct.xml", "test_directional"},
    {"instancing/test_instancing_path.xml", "test_instancing"},
    {"texture_interp/test_texture_interp_direct.xml", "test_texture_interp"},
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

/// A scene of Mitsuba 0.5 with a picture by Tungsten. Ours is smaller: its mean is that of the same
/// view, but for the edge of what a tent filter sees.
TEST(RainbowReferences, MeansAgree) {
    const fs::path folder = kPeers / "rainbow/cornell-box";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    const Scene scene = loadMitsuba(folder / "scene.xml");
    expectSameMean(filmOf(scene, {64, 64, {}}, 128), folder / "TungstenRender.exr", 0.01);
}

/// The t-tests of the course renderer Nori, restated as Mitsuba scenes: the mean of one pixel that
/// looks at one point, 4 standard errors. Theirs is at the significance 0.01, with the same
/// samples.
double noriMean(const std::string& inside, double reference) {
    const fs::path file = fs::path(testing::TempDir()) / "nori_restated.xml";
    std::ofstream(file)
        << "<scene version=\"3.0.0\"><path value=\"" << (kPeers / "nori/pa5/tests").string()
        << "\"/><integrator type=\"path\"><integer name=\"max_depth\" value=\"65\"/></integrator>"
        << inside << "</scene>";
    const Film film = filmOf(loadMitsuba(file), {1, 1, {}}, 20'000);
    const PixelStatistics& pixel = film.pixels.at(0);
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
