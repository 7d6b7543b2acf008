// The Vulkan kernel and the double-precision reference make the same picture of every scene at
// hand: per-pixel, per-block and whole-picture z-tests with a family-wise error of 1e-4 a scene.
// The library has about 25 scenes, so a right renderer fails this suite once in 400 seeds; the
// seeds are fixed.
#include "host/check/cross_check.hpp"
#include "host/cs184/cs184.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/read_scene.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace stromboli {
namespace {

using namespace test;

constexpr uint32_t kWidth = 64, kHeight = 48;

RenderSettings smallSettings(uint32_t samples) {
    RenderSettings s;
    s.area.width = kWidth;
    s.area.height = kHeight;
    s.budget.mostSamplesPerPixel = samples;
    s.estimator.maxBounces = 5;
    return s;
}

void expectAgreement(const vulkan::Device& device, const Scene& scene, const std::string& name,
                     const RenderSettings& settings, const Camera& camera) {
    const Film onDevice = renderOnDevice(device, scene, camera, settings);
    ReferenceBackend reference(scene, camera, settings);
    const Film onHost = render(reference, settings);
    CheckSettings check;
    check.familyError = 1e-4;
    const CheckResult result = crossCheck(onDevice, onHost, check);
    EXPECT_TRUE(result.agree()) << name << "\n" << formatCheck(result);
    EXPECT_GE(result.fractionPassing, 0.9975);
    EXPECT_EQ(result.rejectedA, 0u);
    const auto isLit = [](const PixelStatistics& p) { return p.mean.y > 0; };
    EXPECT_TRUE(std::ranges::any_of(onHost.pixels, isLit)) << name << ": black in both";
}

void expectAgreement(const vulkan::Device& device, const Scene& scene, const std::string& name,
                     const RenderSettings& settings) {
    expectAgreement(device, scene, name, settings,
                    makeCamera(scene, CameraChoice::Automatic, settings.area.width,
                               settings.area.height, framingOf(settings.estimator)));
}

void expectAgreement(const vulkan::Device& device, const std::filesystem::path& file,
                     const RenderSettings& settings) {
    expectAgreement(device, loadScene(file, readingOf(settings.estimator)), file, settings);
}

std::string nameOf(const testing::TestParamInfo<std::filesystem::path>& info) {
    return info.param.stem().string();
}

class Agreement : public DeviceTest, public testing::WithParamInterface<std::filesystem::path> {};

TEST_P(Agreement, WithTheReference) {
    expectAgreement(testDevice(), GetParam(), smallSettings(64));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(allScenes()), nameOf);

/// The bundled glTF scene of which the reference knows its own error in so many samples.
TEST(GltfAgreement, WithTheReference) {
    expectAgreement(testDevice(), readScene("texture_chart"), "texture_chart", smallSettings(64));
}

/// A box is seen from outside where nobody says another thing.
const Camera kInTheRoom = lookingAt({0, 1.6, 1.95}, {0, 1.3, 0}, 1.2);

/// Spheres of principled materials of all kinds in a lit room.
Scene principledRoom() {
    scenes::SceneMaker b;
    const auto add = [&](auto&& change) {
        Material m;
        m.kind = MaterialKind::Principled;
        m.principled.baseColor = {0.9f, 0.7f, 0.4f};
        change(m.principled);
        return b.add(m);
    };
    const uint32_t materials[] = {
        add([](auto& p) { p.roughness = 0.55f; }),
        add([](auto& p) { p.metallic = 0, p.roughness = 0.6f; }),
        add([](auto& p) { p.roughness = 0.6f, p.anisotropy = 0.6f, p.anisotropyRotation = 1; }),
        add([](auto& p) { p.metallic = 0, p.clearcoat = 1, p.clearcoatRoughness = 0.5f; }),
        add([](auto& p) {
            p.metallic = 0, p.sheenColor = {0.5f, 0.6f, 0.9f}, p.sheenRoughness = 0.5f;
        }),
        add([](auto& p) { p.metallic = 0, p.transmission = 0.9f, p.roughness = 0.6f; }),
        add([](auto& p) {
            p.metallic = 0, p.transmission = 1, p.roughness = 0.55f, p.isThin = false;
            p.attenuationColor = {0.3f, 0.8f, 0.5f}, p.attenuationDistance = 0.3f;
        }),
        add([](auto& p) {
            p.metallic = 0, p.diffuseTransmission = 0.6f, p.isThin = false, p.roughness = 0.6f;
            p.attenuationColor = {0.8f, 0.5f, 0.3f}, p.attenuationDistance = 0.5f;
        }),
        add([](auto& p) {
            p.metallic = 0.5f, p.iridescence = 0.8f, p.filmThickness = 300, p.roughness = 0.55f;
        }),
        add([](auto& p) {
            p.metallic = 0, p.transmission = 1, p.isThin = false, p.roughness = 0.6f;
            p.dispersion = 4;
        }),
    };
    b.box({-2, 0, -2}, {2, 3, 2}, b.add(scenes::diffuse(0.6f)), true);
    b.quad({-0.6f, 2.9f, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f}, b.add(scenes::emissive(6)));
    for (int i = 0; i < 10; ++i)
        b.sphere({-1.2f + 0.8f * float(i % 4), 0.4f + 0.9f * float(i / 4), 0.3f * float(i % 3)},
                 0.35f, materials[i]);
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = {1.5f, 1, 1.5f};
    lamp.color = glm::vec3(1);
    lamp.constantAttenuation = 0, lamp.quadraticAttenuation = 1;
    b.add(lamp);
    return b.scene;
}

TEST(PrincipledAgreement, WithTheReference) {
    expectAgreement(testDevice(), principledRoom(), "principled", smallSettings(64), kInTheRoom);
}

/// Clear glass of glTF's model: a sheet, and a volume that absorbs.
TEST(PrincipledAgreement, WithTheReferenceInClearGlass) {
    scenes::SceneMaker b;
    const auto add = [&](bool isThin) {
        Material m;
        m.kind = MaterialKind::Principled;
        m.principled = {.baseColor = {0.9f, 0.7f, 0.5f}, .metallic = 0, .roughness = 0};
        m.principled.transmission = 1, m.principled.isThin = isThin;
        m.principled.specularColor = {1, 0.5f, 0.8f}, m.principled.specular = 0.9f;
        m.principled.attenuationColor = {0.3f, 0.8f, 0.5f};
        m.principled.attenuationDistance = 0.3f;
        return b.add(m);
    };
    b.box({-2, 0, -2}, {2, 3, 2}, b.add(scenes::diffuse(0.6f)), true);
    b.quad({-1.5f, 2.9f, -1.5f}, {3, 0, 0}, {0, 0, 3}, b.add(scenes::emissive(1)));
    b.quad({-1.5f, 0.2f, 0.3f}, {1.4f, 0, 0.4f}, {0, 2, 0}, add(true));
    b.sphere({0.7f, 0.8f, 0}, 0.6f, add(false));
    expectAgreement(testDevice(), b.scene, "clear", smallSettings(64), kInTheRoom);
}

/// As many directions of the hemisphere as the file has lights, which find what shines.
TEST(Cs184Agreement, WithTheReferenceByHemisphere) {
    scenes::SceneMaker b;
    b.box({-2, 0, -2}, {2, 3, 2}, b.add(scenes::diffuse(0.6f)), true);
    b.quad({-0.8f, 2.9f, -0.8f}, {1.6f, 0, 0}, {0, 0, 1.6f}, b.add(scenes::emissive(4)));
    b.sphere({0.7f, 0.8f, 0}, 0.6f, b.add(scenes::diffuse(0.4f)));
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = {-1.5f, 1, 1.2f};
    b.add(lamp);
    RenderSettings settings = smallSettings(128);
    settings.estimator.conventions = cs184Shading();
    settings.estimator.directLight = DirectLight::Hemisphere;
    settings.estimator.lightSamples = 4;
    expectAgreement(testDevice(), b.scene, "hemisphere", settings, kInTheRoom);
}

/// One scene in every mode of the estimator.
struct Mode {
    const char* name;
    const char* scene;
    void (*change)(RenderSettings&);
};

const Mode kModes[] = {
    {"hemisphere", "cornell_boxes.dae",
     [](RenderSettings& s) {
         s.estimator.directLight = DirectLight::Hemisphere, s.estimator.lightSamples = 4;
     }},
    {"bsdf", "cornell_mirror_glass.dae",
     [](RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }},
    {"lightSamples", "cornell_spheres.dae",
     [](RenderSettings& s) { s.estimator.lightSamples = 3; }},
    {"secondBounceAlone", "cornell_boxes.dae",
     [](RenderSettings& s) { s.estimator.minBounce = 2, s.estimator.maxBounces = 2; }},
    {"emissionOnly", "cornell_boxes.dae", [](RenderSettings& s) { s.estimator.maxBounces = 0; }},
    {"fixedRoulette", "cornell_boxes.dae",
     [](RenderSettings& s) {
         s.estimator.maxBounces = 100;
         s.estimator.roulette = {Roulette::Mode::Fixed, 0.3};
     }},
    {"noRoulette", "cornell_mirror_glass.dae",
     [](RenderSettings& s) { s.estimator.roulette.mode = Roulette::Mode::None; }},
    {"normals", "cornell_mesh.dae",
     [](RenderSettings& s) { s.estimator.integrator = Integrator::Normals; }},
    {"depth", "cornell_mesh.dae",
     [](RenderSettings& s) { s.estimator.integrator = Integrator::Depth; }},
    {"lateRoulette", "cornell_boxes.dae",
     [](RenderSettings& s) { s.estimator.roulette.throughputStart = 6; }},
    {"lanczos", "cornell_boxes.dae",
     [](RenderSettings& s) { s.estimator.filter = PixelFilter::Lanczos; }},
    {"flatTerminator", "cornell_mesh.dae",
     [](RenderSettings& s) { s.estimator.conventions.offsetsTerminator = false; }},
    {"cs184", "cornell_metal.dae",
     [](RenderSettings& s) { s.estimator.conventions = cs184Shading(); }},
    {"cs184Glass", "cornell_mirror_glass.dae",
     [](RenderSettings& s) { s.estimator.conventions = cs184Shading(); }},
    {"cs184Sun", "light_directional.dae",
     [](RenderSettings& s) { s.estimator.conventions = cs184Shading(); }},
    {"ambientByBounces", "light_ambient.dae",
     [](RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }},
    {"sphereByHemisphere", "light_sphere.dae",
     [](RenderSettings& s) { s.estimator.directLight = DirectLight::Hemisphere; }},
    {"meshByBounces", "light_mesh.dae",
     [](RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }},
};

class ModeAgreement : public DeviceTest, public testing::WithParamInterface<Mode> {};

TEST_P(ModeAgreement, WithTheReference) {
    RenderSettings settings = smallSettings(128);
    GetParam().change(settings);
    expectAgreement(
        testDevice(),
        std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library" / GetParam().scene, settings);
}

INSTANTIATE_TEST_SUITE_P(Modes, ModeAgreement, testing::ValuesIn(kModes),
                         [](const auto& test) { return std::string(test.param.name); });

/// A scene in which each rule of surfaces and of the sky matters: a lamp in glass of a high index,
/// a smooth and a rough metal that absorb little, a mirror of the sky, a roof whose normals lean
/// far away from it, and all of it seen and lit from below too.
Scene roomOfRules() {
    scenes::SceneMaker b;
    b.sphere({-1.3f, 0, 0}, 0.6f, b.add(scenes::glass(2.2f)));
    b.sphere({-1.3f, 0, 0}, 0.2f, b.add(scenes::emissive(3)));
    Material metal;
    metal.kind = MaterialKind::Conductor;
    metal.eta = glm::vec3(0.6f);
    metal.k = glm::vec3(0.4f);
    b.sphere({0, 0.7f, 0}, 0.5f, b.add(metal));
    metal.facets = {FacetDistribution::Beckmann, glm::vec2(1), FacetMasking::Separable};
    b.sphere({0, -0.6f, 0}, 0.6f, b.add(metal));
    b.sphere({1.2f, -0.6f, 0}, 0.5f, b.add(scenes::mirror(0.9f)));
    const auto corner = uint32_t(b.scene.positions.size()),
               normal = uint32_t(b.scene.normals.size());
    const size_t first = b.scene.triangles.size();
    b.quad({0.7f, 0.6f, 0.6f}, {1, 0, 0}, {0, 0.3f, -1}, b.add(scenes::diffuse(0.8f)));
    for (size_t i = corner; i < b.scene.positions.size(); ++i) {
        const float side = b.scene.positions[i].x > 1.2f ? -0.9f : 0.9f; // hollow: not lifted
        b.scene.normals.push_back(glm::normalize(glm::vec3(side, 0.4f, 0.1f)));
    }
    for (size_t i = first; i < b.scene.triangles.size(); ++i)
        for (int c = 0; c < 3; ++c)
            b.scene.triangles[i].normals[c] = normal + b.scene.triangles[i].corner[c] - corner;
    b.add(scenes::ambient(0.5f));
    b.add(Light{
        .kind = LightKind::Directional, .color = {1, 1, 1}, .direction = {-0.6f, -0.6f, -0.5f}});
    return b.scene;
}

/// Rectangles of the file that are sampled and not seen.
Scene roomWithARectangle() {
    SceneConventions reading;
    reading.areaLights = AreaLights::StayLights;
    return loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/light_area.dae",
                     reading);
}

/// A single rule of shading that does not hold, and all others hold, or those that go with it: the
/// kernel and the reference take any mixture alike.
struct Departure {
    const char* name;
    Scene (*scene)();
    void (*change)(ShadingConventions&);
};

const Departure kDepartures[] = {
    {"facesForward", roomOfRules, [](auto& c) { c.facesForward = false; }},
    {"geometricSide", roomOfRules, [](auto& c) { c.testsGeometricSide = false; }},
    {"fresnel", roomOfRules, [](auto& c) { c.exactFresnel = false; }},
    {"lambda", roomOfRules, [](auto& c) { c.exactLambda = false; }},
    {"radiance", roomOfRules, [](auto& c) { c.compressesRadiance = false; }},
    {"bounces", roomOfRules, [](auto& c) { c.bouncesFindAllLight = false; }},
    {"ambient", roomOfRules, [](auto& c) { c.ambientAboutNormal = c.bouncesFindAllLight = false; }},
    {"rectangles", roomWithARectangle,
     [](auto& c) {
         c.samplesEmitters = c.bouncesFindAllLight = false;
         c.everyLightInTurn = true;
     }},
    {"falloff", roomWithARectangle, [](auto& c) {
         c.inverseSquareFalloff = c.samplesEmitters = c.bouncesFindAllLight = false;
         c.everyLightInTurn = true;
     }}};

class DepartureAgreement : public DeviceTest, public testing::WithParamInterface<Departure> {};

TEST_P(DepartureAgreement, WithTheReference) {
    RenderSettings settings = smallSettings(128);
    GetParam().change(settings.estimator.conventions);
    expectAgreement(testDevice(), GetParam().scene(), GetParam().name, settings);
}

INSTANTIATE_TEST_SUITE_P(Rules, DepartureAgreement, testing::ValuesIn(kDepartures),
                         [](const auto& test) { return std::string(test.param.name); });

/// Many emissive triangles: the kernel walks its tree, the reference picks by power.
TEST_F(DeviceTest, AgreementOnManyEmitters) {
    RenderSettings settings = smallSettings(128);
    settings.area.width = settings.area.height = 48;
    settings.estimator.maxBounces = 2;
    const Scene scene = readScene("generate:lamps:400");
    const Camera camera =
        makeCamera(scene, CameraChoice::Automatic, settings.area.width, settings.area.height);
    ReferenceBackend reference(scene, camera, settings);
    CheckSettings check;
    check.familyError = 1e-4;
    const CheckResult result = crossCheck(renderOnDevice(testDevice(), scene, camera, settings),
                                          render(reference, settings), check);
    EXPECT_TRUE(result.agree()) << formatCheck(result);
    EXPECT_EQ(result.rejectedA, 0u);
}

/// The check has teeth: two per cent more light in the reference's picture is found.
TEST_F(DeviceTest, AgreementFailsForTwoPerCentMoreLight) {
    RenderSettings settings = smallSettings(256);
    const auto file =
        std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/cornell_boxes.dae";
    const Scene scene = loadScene(file);
    Scene brighter = scene;
    for (Material& m : brighter.materials)
        m.emission *= 1.02f;
    const Camera camera =
        makeCamera(scene, CameraChoice::Automatic, settings.area.width, settings.area.height);
    const Film a = renderOnDevice(testDevice(), scene, camera, settings);
    ReferenceBackend reference(brighter, camera, settings);
    EXPECT_FALSE(crossCheck(a, render(reference, settings)).agree());
}

/// The reference sends no bounces into gaps.
struct Gap {
    const char* name;
    float height; ///< of the emitter, m; the ceiling is at 2
    float tilt;   ///< height of one edge over the other
    bool turned;  ///< the room on its head: the gap is on the emitter's other side
};

class GapAgreement : public DeviceTest, public testing::WithParamInterface<Gap> {
  protected:
    static Scene room() {
        Scene scene = loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) /
                                "scene/library/cornell_boxes.dae");
        const Gap gap = GetParam();
        for (const Triangle& t : scene.triangles)
            if (scene.materials[t.material].emission.x > 0)
                for (const uint32_t corner : t.corner) {
                    glm::vec3& p = scene.positions[corner];
                    p.y = gap.height + (p.x > 0 ? gap.tilt : 0);
                }
        for (glm::vec3& p : scene.positions)
            if (gap.turned) p = glm::vec3(-p.x, 2 - p.y, p.z); // about the view
        return scene;
    }
};

TEST_P(GapAgreement, WithTheReference) {
    const Scene scene = room();
    const GpuScene packed = packScene(scene, buildWideBvh(scene));
    ASSERT_NE(packed.gapWidth, 0);
    RenderSettings settings = smallSettings(256);
    settings.estimator.minBounce = 2,
    settings.estimator.maxBounces = 3; // light out of the gap, and once more
    expectAgreement(testDevice(), scene, GetParam().name, settings);
}

INSTANTIATE_TEST_SUITE_P(Rooms, GapAgreement,
                         testing::Values(Gap{"narrow", 1.998f, 0, false},
                                         Gap{"wide", 1.85f, 0, false},
                                         Gap{"tilted", 1.95f, 0.03f, false},
                                         Gap{"turned", 1.98f, 0, true}),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace stromboli
