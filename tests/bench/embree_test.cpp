// Embree as the benchmark uses it: what it is compared with must do the same work.
#include "host/bench/embree.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/check/cross_check.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/render.hpp"
#include "scene/read_scene.hpp"
#include "tests/bench/bench_fixtures.hpp"

#include <gtest/gtest.h>

namespace stromboli::bench {
namespace {

using test::libraryPicture;
using test::LibraryPicture;

/// The one that all tests share.
const Embree& embree(uint32_t threads = 2) {
    static const OpenedEmbree two = openEmbree(2), one = openEmbree(1);
    const OpenedEmbree& opened = threads == 1 ? one : two;
    if (!opened.embree) throw std::runtime_error("no Embree: " + opened.missing);
    return *opened.embree;
}

std::unique_ptr<EmbreeScene> build(const Scene& scene, EmbreeMode mode = EmbreeMode::Robust,
                                   EmbreeQuality quality = EmbreeQuality::Medium,
                                   uint32_t threads = 2) {
    return embree(threads).build(embree(threads).geometry(scene), mode, quality);
}

Film paint(const LibraryPicture& p, EmbreeMode mode, uint32_t threads = 2) {
    const auto scene = build(p.scene, mode, EmbreeQuality::Medium, threads);
    const auto tracer = scene->pathTracer(p.scene, p.camera, p.settings);
    return render(*tracer, p.settings);
}

Film paintReference(const LibraryPicture& p) {
    ReferenceBackend backend(p.scene, p.camera, p.settings);
    return render(backend, p.settings);
}

TEST(Embree, SaysWhatItIs) {
    EXPECT_EQ(embree().version().substr(0, 2), "3.");
    EXPECT_NE(embree().compiledWith().find("-O3"), std::string::npos);
}

TEST(Embree, ModesAndQualitiesAgreeOnRays) {
    const LibraryPicture p = libraryPicture("cornell_mesh");
    const RaySets sets = makeRaySets(p.scene, p.camera, p.settings, 1);
    for (const RaySet* set : {&sets.camera, &sets.shadow, &sets.bounce}) {
        const std::vector<float> expected = build(p.scene)->distances(*set);
        for (const EmbreeMode mode : {EmbreeMode::Fast, EmbreeMode::Robust})
            for (const EmbreeQuality quality : {EmbreeQuality::Medium, EmbreeQuality::High}) {
                const auto scene = build(p.scene, mode, quality);
                const std::vector<float> found = scene->distances(*set);
                EXPECT_LE(countDisagreements(*set, expected, found), set->rays.size() / 500);
                const RayTotals totals = scene->trace(*set);
                EXPECT_GT(totals.hits, 0u);
                EXPECT_LT(totals.hits, set->rays.size());
                EXPECT_GT(scene->bytes, 50'000u * 16); // of 50,000 triangles
            }
    }
}

/// A family-wise error of 1e-4 a picture, 24 pictures: one false alarm in 400 seeds.
class EmbreePaths : public testing::TestWithParam<const char*> {};

TEST_P(EmbreePaths, MakeTheReferencesPicture) {
    const LibraryPicture p = libraryPicture(GetParam(), 48, 36, 64);
    ASSERT_EQ(embreePathsLack(p.scene, p.settings), "");
    CheckSettings check;
    check.familyError = 1e-4;
    const Film reference = paintReference(p);
    for (const EmbreeMode mode : {EmbreeMode::Fast, EmbreeMode::Robust}) {
        const CheckResult result = crossCheck(paint(p, mode), reference, check);
        EXPECT_TRUE(result.agree()) << formatCheck(result);
        EXPECT_EQ(result.rejectedA, 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EmbreePaths,
                         testing::Values("cornell_boxes", "cornell_spheres", "cornell_mesh",
                                         "cornell_mirror_glass", "island", "light_ambient",
                                         "light_directional", "light_mesh", "light_point",
                                         "light_sphere", "light_spot", "ortho"),
                         [](const auto& test) { return std::string(test.param); });

TEST(EmbreePathsOf, ManyEmittersMakeTheReferencesPicture) {
    LibraryPicture p = libraryPicture("cornell_boxes", 48, 36, 64);
    p.scene = readScene("generate:lamps:400");
    p.settings.estimator.maxBounces = 2;
    p.camera = makeCamera(p.scene, CameraChoice::Automatic, 48, 36);
    CheckSettings check;
    check.familyError = 1e-4;
    const Film reference = paintReference(p);
    for (const LightChoice choice : {LightChoice::Tree, LightChoice::Uniform}) {
        p.settings.estimator.lightChoice = choice;
        const CheckResult result = crossCheck(paint(p, EmbreeMode::Robust), reference, check);
        EXPECT_TRUE(result.agree()) << formatCheck(result);
    }
}

struct Mode {
    const char* name;
    void (*change)(RenderSettings&);
};

class EmbreePathsWith : public testing::TestWithParam<Mode> {};

TEST_P(EmbreePathsWith, MakeTheReferencesPicture) {
    LibraryPicture p = libraryPicture("cornell_mirror_glass", 48, 36, 64);
    GetParam().change(p.settings);
    CheckSettings check;
    check.familyError = 1e-4;
    const CheckResult result = crossCheck(paint(p, EmbreeMode::Robust), paintReference(p), check);
    EXPECT_TRUE(result.agree()) << formatCheck(result);
}

const Mode kModes[] = {
    {"noRoulette", [](RenderSettings& s) { s.estimator.roulette.mode = Roulette::Mode::None; }},
    {"fixedRoulette",
     [](RenderSettings& s) {
         s.estimator.maxBounces = 50;
         s.estimator.roulette = {Roulette::Mode::Fixed, 0.3};
     }},
    {"severalLightSamples", [](RenderSettings& s) { s.estimator.lightSamples = 3; }},
    {"secondBounceAlone",
     [](RenderSettings& s) { s.estimator.minBounce = s.estimator.maxBounces = 2; }},
    {"emissionOnly", [](RenderSettings& s) { s.estimator.maxBounces = 0; }},
};

INSTANTIATE_TEST_SUITE_P(Modes, EmbreePathsWith, testing::ValuesIn(kModes),
                         [](const auto& test) { return std::string(test.param.name); });

/// The check has teeth: two per cent more light is found.
TEST(EmbreePaths, TwoPerCentMoreLightIsFound) {
    const LibraryPicture p = libraryPicture("cornell_boxes", 64, 48, 256);
    LibraryPicture brighter = p;
    for (Material& m : brighter.scene.materials)
        m.emission *= 1.02f;
    EXPECT_FALSE(crossCheck(paint(brighter, EmbreeMode::Robust), paintReference(p)).agree());
}

bool sameFilm(const Film& a, const Film& b) {
    return std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), b.pixels.end(),
                      [](const PixelStatistics& x, const PixelStatistics& y) {
                          return x.mean == y.mean && x.m2 == y.m2 && x.count == y.count;
                      });
}

TEST(EmbreePaths, ThreadsDoNotChangeThePicture) {
    const LibraryPicture p = libraryPicture("cornell_boxes", 48, 36, 8);
    EXPECT_TRUE(sameFilm(paint(p, EmbreeMode::Robust, 1), paint(p, EmbreeMode::Robust, 2)));
}

TEST(EmbreePaths, SamplesAloneAreThoseOfThePicture) {
    const LibraryPicture p = libraryPicture("cornell_boxes", 48, 36, 2);
    const auto scene = build(p.scene);
    const auto tracer = scene->pathTracer(p.scene, p.camera, p.settings);
    const Film film = render(*tracer, p.settings);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); pixel += 97) {
        const glm::dvec3 sum =
            tracer->sampleAlone(pixel, 0).radiance + tracer->sampleAlone(pixel, 1).radiance;
        EXPECT_EQ(film.pixels[pixel].mean, sum / 2.0);
    }
}

TEST(EmbreePaths, SayWhatTheyLack) {
    LibraryPicture p = libraryPicture("cornell_metal");
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "microfacet materials");
    p = libraryPicture("cornell_boxes");
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "");
    p.settings.estimator.directLight = DirectLight::Hemisphere;
    EXPECT_NE(embreePathsLack(p.scene, p.settings), "");
    p.settings = {};
    p.settings.estimator.filter = PixelFilter::Gaussian;
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "pixel filters");
    p.settings = {};
    const Scene plain = p.scene;
    p.scene.environment.emplace();
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "environments");
    p.scene = plain;
    p.scene.attributes.emplace_back();
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "textures and colours of corners");
    p.scene = plain;
    p.scene.materials[p.scene.triangles[0].material].alphaMode = AlphaMode::Blend;
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "surfaces that are partly not there");
    p.scene.materials[p.scene.triangles[0].material].kind = MaterialKind::Principled;
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "principled materials");
    p.scene = plain;
    p.settings.estimator.conventions = cs184Shading();
    EXPECT_EQ(embreePathsLack(p.scene, p.settings), "other shading conventions than the default");
}

} // namespace
} // namespace stromboli::bench
