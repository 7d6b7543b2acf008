// The product kernel against the textbook's loops (nested.comp): the same picture bit for bit,
// whatever the scene needs and however the product's work is cut. A form of the product's loop was
// once compiled wrongly by a driver; nothing but such a comparison would show it.
#include "host/bvh/wide_layout.hpp"
#include "host/cs184/cs184.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/add_fog.hpp"
#include "scene/generate/generated_scene.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/read_scene.hpp"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/nested_texel.h"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace stromboli {
namespace {

using namespace test;

/// llvmpipe ends the loops of a group of 8 lanes after 65,535 passes by all of them.
constexpr uint32_t kLoopPassesPerLane = 65535 / 8;
constexpr uint32_t kSamples = 5, kSamplesPerDispatch = 2;

struct NestedPicture {
    const char* name;
    const char* scene;
    void (*change)(Scene&, RenderSettings&);
    bool cs184 = false;
};

/// Rough metal in the place of all that scatters.
void makeMetal(Scene& scene) {
    for (Material& m : scene.materials) {
        m.kind = MaterialKind::Conductor;
        m.facets = {FacetDistribution::Beckmann, glm::vec2(0.2f)};
        m.eta = glm::vec3(1.5f), m.k = glm::vec3(3);
    }
}

/// A lamp before a wall, and a light of the file: a hemisphere gets as many directions as there
/// are.
Scene litWall() {
    scenes::SceneMaker b;
    b.quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, b.add(scenes::diffuse(0.6f)));
    b.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, b.add(scenes::emissive(4)));
    Light lamp;
    lamp.position = {1.5f, 1, 1.5f};
    b.add(lamp);
    return b.scene;
}

/// Every material, kind of light, way of sampling, roulette, integrator and camera of the kernel.
const NestedPicture kNestedPictures[] = {
    {"diffuse", "cornell_boxes.dae", [](Scene&, RenderSettings&) {}},
    {"spheres", "cornell_spheres.dae",
     [](Scene&, RenderSettings& s) { s.estimator.lightSamples = 3; }},
    {"mirrorAndGlass", "cornell_mirror_glass.dae",
     [](Scene&, RenderSettings& s) { s.estimator.maxBounces = 9; }},
    {"refraction", "cornell_mirror_glass.dae",
     [](Scene& scene, RenderSettings&) {
         for (Material& m : scene.materials)
             if (m.kind == MaterialKind::Dielectric) m.kind = MaterialKind::Refraction;
     }},
    {"metal", "cornell_metal.dae", [](Scene&, RenderSettings&) {}},
    {"metalUnderAMesh", "light_mesh.dae", [](Scene& scene, RenderSettings&) { makeMetal(scene); }},
    {"metalUnderSpheres", "light_sphere.dae",
     [](Scene& scene, RenderSettings& s) {
         makeMetal(scene);
         s.estimator.lightSamples = 2;
     }},
    {"metalUnderTheSky", "light_ambient.dae",
     [](Scene& scene, RenderSettings&) { makeMetal(scene); }},
    {"metalUnderManyLights", "generate:lamps:1000",
     [](Scene& scene, RenderSettings&) { makeMetal(scene); }},
    {"mesh", "cornell_mesh.dae", [](Scene&, RenderSettings&) {}},
    {"meshEmitter", "light_mesh.dae", [](Scene&, RenderSettings&) {}},
    {"manyLights", "generate:lamps:1000", [](Scene&, RenderSettings&) {}},
    {"sphereEmitters", "light_sphere.dae", [](Scene&, RenderSettings&) {}},
    {"ambient", "light_ambient.dae", [](Scene&, RenderSettings&) {}},
    {"sun", "light_directional.dae", [](Scene&, RenderSettings&) {}},
    {"point", "light_point.dae", [](Scene&, RenderSettings&) {}},
    {"spots", "light_spot.dae", [](Scene&, RenderSettings&) {}},
    {"orthographic", "ortho.dae", [](Scene&, RenderSettings&) {}},
    {"hemisphere", "cornell_boxes.dae",
     [](Scene&, RenderSettings& s) {
         s.estimator.directLight = DirectLight::Hemisphere;
         s.estimator.lightSamples = 3;
     }},
    {"lightsByBounces", "cornell_mirror_glass.dae",
     [](Scene&, RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }},
    {"secondBounceAlone", "cornell_boxes.dae",
     [](Scene&, RenderSettings& s) { s.estimator.minBounce = s.estimator.maxBounces = 2; }},
    {"emissionOnly", "cornell_boxes.dae",
     [](Scene&, RenderSettings& s) { s.estimator.maxBounces = 0; }},
    {"fixedRoulette", "cornell_boxes.dae",
     [](Scene&, RenderSettings& s) {
         s.estimator.maxBounces = 100;
         s.estimator.roulette = {Roulette::Mode::Fixed, 0.3};
     }},
    {"noRoulette", "cornell_boxes.dae",
     [](Scene&, RenderSettings& s) { s.estimator.roulette.mode = Roulette::Mode::None; }},
    {"branches", "cornell_boxes.dae", [](Scene&, RenderSettings& s) { s.estimator.branches = 4; }},
    {"branchesBehindGlass", "cornell_mirror_glass.dae",
     [](Scene&, RenderSettings& s) { s.estimator.branches = 3; }},
    {"branchesOfMetal", "cornell_metal.dae",
     [](Scene&, RenderSettings& s) { s.estimator.branches = 2; }},
    {"fogUnderTheSky", "light_ambient.dae",
     [](Scene& scene, RenderSettings&) { addFog(scene, {.density = 0.5, .asymmetry = 0.5}); }},
    {"fogAroundGlass", "cornell_mirror_glass.dae",
     [](Scene& scene, RenderSettings& s) {
         addFog(scene, {.density = 0.5, .color = {1, 0.5f, 0.25f}});
         s.estimator.branches = 2;
     }},
    {"normals", "cornell_mesh.dae",
     [](Scene&, RenderSettings& s) { s.estimator.integrator = Integrator::Normals; }},
    {"cs184Glass", "cornell_mirror_glass.dae", [](Scene&, RenderSettings&) {}, true},
    {"cs184Metal", "cornell_metal.dae", [](Scene&, RenderSettings&) {}, true},
    {"cs184Hemisphere", "cornell_boxes.dae",
     [](Scene& scene, RenderSettings& s) {
         s.estimator.directLight = DirectLight::Hemisphere;
         scene = litWall();
     },
     true},
    {"rejectedSamples", "cornell_boxes.dae",
     [](Scene& scene, RenderSettings&) { // emitters brighter than a sample may be
         for (Material& m : scene.materials)
             m.emission *= 1e20f;
     }},
};

/// What suits the device, few lanes, many, groups of several widths, work lists of one pixel, paths
/// that are put off at every bounce, and all of it at once. The last, for which driver and
/// validation layer read the module with everything in it, takes ten times as long as others and is
/// for one picture. tests/spirv compares the two specialisers on all that constants decide.
const KernelTuning kTunings[] = {
    {},
    {.lanes = 8},
    {.workgroupSize = 64, .lanes = 1000},
    {.traversalSteps = 1, .fixedIterations = 40},
    {.itemsPerDispatch = 7, .fixedIterations = 3},
    {.workgroupSize = 24, .traversalSteps = 3, .lanes = 100, .fixedIterations = 1},
    {.texelFetch = false, .traversalSteps = 16, .stepsBranch = true}, // as GPUs
    {.countSteps = true, .everythingOn = true},
    {.specialiser = vulkan::Specialiser::Drivers},
};
constexpr size_t kTuningsOfPictures = std::size(kTunings) - 1;

struct Result {
    Film film;
    uint64_t rays = 0;
};

class NestedKernel : public DeviceTest {
  protected:
    void load(const NestedPicture& picture) {
        settings_.area.width = 37,
        settings_.area.height = 27; // no multiples of a tile or a workgroup
        settings_.budget.mostSamplesPerPixel = kSamples;
        settings_.estimator.maxBounces = 5;
        const auto library = std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library";
        if (picture.cs184) settings_.estimator.conventions = cs184Shading();
        Scene scene = std::string_view(picture.scene).starts_with(kGeneratePrefix)
                          ? readScene(picture.scene)
                          : loadScene(library / picture.scene, readingOf(settings_.estimator));
        picture.change(scene, settings_);
        camera_ = makeCamera(scene, CameraChoice::Automatic, settings_.area.width,
                             settings_.area.height, framingOf(settings_.estimator));
        scene_ = packScene(scene, buildWideBvh(scene), lightSelection(settings_.estimator));
    }

    Result product(const KernelTuning& tuning) const {
        VulkanBackend backend(testDevice(), scene_, camera_, settings_, tuning);
        Film film = render(backend, settings_);
        return {std::move(film), backend.counters().rays};
    }

    Result nested() const {
        ShaderOptions options = ShaderOptions::texel();
        options.constants =
            kernelFeatures(scene_, camera_, settings_.estimator, {.workgroupSize = 8});
        TestShader shader(nested_texel, options);
        shader.setScene(scene_);
        shader.setOne(BINDING_FRAME,
                      makeFrame(scene_, camera_, settings_.area, settings_.estimator));
        gpu::PixelState empty{};
        empty.firstRejected = 0xFFFFFFFFu;
        const uint32_t pixels = settings_.area.width * settings_.area.height;
        shader.set(BINDING_PIXELS, std::vector(pixels, empty));
        shader.setOne(BINDING_STATUS, gpu::DispatchStatus{});
        for (uint32_t done = 0; done < kSamples; done += kSamplesPerDispatch) {
            gpu::Dispatch constants{};
            constants.segmentBase = std::min(kSamplesPerDispatch, kSamples - done);
            shader.run(pixels, constants);
        }
        const auto status = shader.get<gpu::DispatchStatus>(BINDING_STATUS, 1)[0];
        EXPECT_LT(status.allSteps, kLoopPassesPerLane) << "take fewer samples per dispatch";
        return {filmOf(shader.get<gpu::PixelState>(BINDING_PIXELS, pixels)), status.rays};
    }

    static void expectSame(const Result& a, const Result& b, const std::string& what) {
        EXPECT_EQ(differingPixels(a.film, b.film), 0u)
            << what << ": of " << a.film.pixels.size() << " pixels";
        EXPECT_EQ(a.rays, b.rays) << what;
    }

    RenderSettings settings_;

  private:
    /// As the product reads its states back: every field, two floats exactly in a double.
    Film filmOf(const std::vector<gpu::PixelState>& states) const {
        Film film(settings_.area.width, settings_.area.height);
        for (size_t i = 0; i < states.size(); ++i) {
            const gpu::PixelState& s = states[i];
            PixelStatistics& p = film.pixels[i];
            p.count = s.count;
            p.rejected = s.rejected;
            p.firstRejected = s.firstRejected;
            if (s.count == 0) continue;
            p.mean = (glm::dvec3(s.sum) + glm::dvec3(s.sumError)) / double(s.count);
            p.m2 = glm::dvec3(s.m2) + glm::dvec3(s.m2Error);
        }
        return film;
    }

    GpuScene scene_;
    Camera camera_;
};

class NestedPictures : public NestedKernel, public testing::WithParamInterface<size_t> {};

TEST_P(NestedPictures, AreTheProductsBitForBit) {
    const NestedPicture& picture = kNestedPictures[GetParam()];
    load(picture);
    const Result textbook = nested();
    uint64_t samples = 0, rejected = 0;
    double light = 0;
    for (const PixelStatistics& p : textbook.film.pixels)
        samples += p.taken(), rejected += p.rejected, light += p.mean.y;
    EXPECT_EQ(light > 0, std::string(picture.name) != "rejectedSamples") << "black in both";
    EXPECT_EQ(samples, uint64_t(settings_.area.width) * settings_.area.height * kSamples);
    EXPECT_EQ(rejected > 0, std::string(picture.name) == "rejectedSamples");
    const size_t tuning = GetParam() % kTuningsOfPictures; // each in turn
    expectSame(product(kTunings[tuning]), textbook, "tuning " + std::to_string(tuning));
}

INSTANTIATE_TEST_SUITE_P(Scenes, NestedPictures,
                         testing::Range<size_t>(0, std::size(kNestedPictures)),
                         [](const auto& test) {
                             return std::string(kNestedPictures[test.param].name);
                         });

/// Lanes stop with some branches done, and go on. Without branches each tuning has its pictures
/// above.
TEST_F(NestedKernel, AgreesOnBranchesWithEveryTuning) {
    load(kNestedPictures[2]); // mirror and glass: paths of very different lengths
    settings_.estimator.branches = 3;
    const Result textbook = nested();
    for (size_t i = 0; i < std::size(kTunings); ++i)
        expectSame(product(kTunings[i]), textbook, "tuning " + std::to_string(i));
}

/// The comparison has teeth: another seed is another picture.
TEST_F(NestedKernel, DiffersForAnotherSeed) {
    load(kNestedPictures[0]);
    const Result textbook = nested();
    settings_.estimator.seed = 1;
    const Result other = product({});
    size_t same = 0;
    for (size_t i = 0; i < other.film.pixels.size(); ++i)
        same += other.film.pixels[i].mean == textbook.film.pixels[i].mean;
    EXPECT_LT(same, other.film.pixels.size() / 2);
}

} // namespace
} // namespace stromboli
