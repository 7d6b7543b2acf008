// Pictures of a room with all that textures, colours of corners, normal maps and opacity can be:
// the kernel and the reference agree on it (z-tests with a family-wise error of 1e-4 a mode, fixed
// seeds), and the kernel gives the same bytes however its work is cut.
#include "host/core/random.hpp"
#include "tests/analytic/textured.hpp"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

/// Texture coordinates by position, along two axes.
std::function<VertexAttributes(const glm::vec3&)> projected(int u, int v, float scale) {
    return [=](const glm::vec3& p) {
        VertexAttributes a;
        a.uv[0] = scale * glm::vec2(p[u], -p[v]);
        a.uv[1] = scale * glm::vec2(p[v], p[u]);
        a.color = {0.5f + 0.4f * p.x, 1, 0.6f - 0.3f * p.z, 1};
        return a;
    };
}

Scene texturedRoom() {
    SceneMaker b;
    TextureMaker t(b.scene);
    Random random(3);
    std::vector<glm::vec4> noise, bumps, leaf;
    for (int i = 0; i < 64; ++i) {
        const auto u = [&] { return float(random.uniform()); };
        noise.emplace_back(u(), u(), u(), u());
        bumps.emplace_back(0.2f + 0.6f * u(), 0.2f + 0.6f * u(), 1, 1);
        leaf.emplace_back(u(), 0.5f, u(), u() < 0.5f ? 0.0f : 1.0f);
    }
    const uint32_t paper = t.texture({.image = t.bytes(8, 8, noise), .srgb = true});
    const uint32_t soft = t.texture({.image = t.halves(16, 4, noise), .wrapV = Wrap::Mirror});
    const uint32_t normals = t.texture(t.bytes(8, 8, bumps));
    const uint32_t cut = t.texture({.image = t.bytes(8, 8, leaf), .nearest = true});

    Material wall = diffuse(0.9f);
    wall.textures = {{.slot = TextureSlot::BaseColor, .texture = paper},
                     {.slot = TextureSlot::Normal, .texture = normals, .scale = 0.8f}};
    b.box({-1, -1, -1}, {1, 1, 1}, b.add(wall), true);
    t.attributes(12, [](const glm::vec3& p) {
        VertexAttributes a = projected(0, 1, 2)(p);
        a.uv[0] += glm::vec2(p.z, -1.3f * p.z);
        return a;
    });
    Material lamp = emissive(6, false);
    lamp.textures = {{.slot = TextureSlot::Emission, .texture = soft, .uvSet = 1}};
    b.quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, b.add(lamp));
    t.attributes(2, projected(0, 2, 1));
    Material maskedLamp = emissive(3);
    maskedLamp.alphaMode = AlphaMode::Mask;
    maskedLamp.textures = {{.slot = TextureSlot::BaseColor, .texture = cut}};
    b.quad({-0.9f, -0.5f, -0.8f}, {0, 0, 0.6f}, {0, 0.6f, 0.1f}, b.add(maskedLamp));
    t.attributes(2, projected(2, 1, 1.5f));
    Material plate = metal(0.3f);
    plate.textures = {{.slot = TextureSlot::Normal, .texture = normals}};
    b.quad({-0.8f, -0.95f, -0.8f}, {0, 0, 1.4f}, {1.4f, 0.2f, 0}, b.add(plate));
    t.attributes(2, [](const glm::vec3& p) {
        VertexAttributes a = projected(2, 0, 1)(p);
        a.tangent = {0, 0, 1, -1};
        return a;
    });
    Material curtain = diffuse(0.7f);
    curtain.alphaMode = AlphaMode::Blend;
    curtain.textures = {{.slot = TextureSlot::BaseColor, .texture = soft}};
    const uint32_t curtains = b.add(curtain);
    for (int i = 0; i < 2; ++i) { // in one place
        b.quad({-0.2f, -0.8f, 0.1f}, {0.8f, 0, 0.2f}, {0, 1.2f, 0}, curtains);
        t.attributes(2, projected(0, 1, 0.7f));
    }
    Material rich;
    rich.kind = MaterialKind::Principled;
    rich.principled = {.metallic = 0.8f,
                       .roughness = 0.7f,
                       .clearcoat = 0.8f,
                       .clearcoatRoughness = 0.5f,
                       .sheenColor = glm::vec3(0.5f, 0.8f, 0.3f),
                       .sheenRoughness = 0.8f,
                       .anisotropy = 0.7f,
                       .anisotropyRotation = 0.4f};
    for (const TextureSlot slot :
         {TextureSlot::Anisotropy, TextureSlot::BaseColor, TextureSlot::MetallicRoughness,
          TextureSlot::Specular, TextureSlot::SpecularColor, TextureSlot::Clearcoat,
          TextureSlot::ClearcoatRoughness, TextureSlot::SheenColor, TextureSlot::SheenRoughness})
        rich.textures.push_back({.slot = slot, .texture = soft});
    rich.textures.push_back({.slot = TextureSlot::Normal, .texture = normals, .scale = 0.5f});
    b.quad({0.3f, -0.9f, -0.95f}, {0.6f, 0, 0}, {0, 1.6f, -0.02f}, b.add(rich));
    t.attributes(2, [](const glm::vec3& p) {
        VertexAttributes a = projected(0, 1, 0.6f)(p);
        a.tangent = {0.6f, 0.8f, 0, 1};
        return a;
    });
    Material sheet;
    sheet.kind = MaterialKind::Principled;
    sheet.principled = {.metallic = 0, .roughness = 0.6f, .transmission = 0.9f};
    sheet.principled.diffuseTransmission = 0.7f;
    sheet.principled.iridescence = 0.9f;
    sheet.principled.filmThickness = 150, sheet.principled.filmSpan = 400;
    sheet.textures = {{.slot = TextureSlot::Transmission, .texture = soft},
                      {.slot = TextureSlot::BaseColor, .texture = paper},
                      {.slot = TextureSlot::DiffuseTransmission, .texture = soft},
                      {.slot = TextureSlot::DiffuseTransmissionColor, .texture = soft},
                      {.slot = TextureSlot::Iridescence, .texture = soft},
                      {.slot = TextureSlot::FilmThickness, .texture = soft}};
    b.quad({-0.9f, -0.2f, 0.3f}, {0.5f, 0, -0.2f}, {0, 0.7f, 0}, b.add(sheet));
    t.attributes(2, projected(0, 1, 0.9f));
    b.sphere({0.5f, -0.5f, -0.4f}, 0.3f, b.add(glass(1.5f)));
    Material veil = diffuse(0.5f);
    veil.alphaMode = AlphaMode::Blend;
    veil.opacity = 0.4f;
    b.sphere({-0.4f, 0.1f, -0.3f}, 0.25f, b.add(veil));
    t.attributes(0, {});
    return b.scene;
}

struct Mode {
    const char* name;
    void (*change)(RenderSettings&);
};
const Mode kModes[] = {
    {"mis", [](RenderSettings&) {}},
    {"misAll", [](RenderSettings& s) { s.estimator.directLight = DirectLight::MisAll; }},
    {"hemisphere", [](RenderSettings& s) { s.estimator.directLight = DirectLight::Hemisphere; }},
    {"bsdf", [](RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }},
    {"branches",
     [](RenderSettings& s) { // 96 branches a pixel: more than other modes have paths
         s.estimator.branches = 3;
         s.budget.mostSamplesPerPixel /= 2;
     }},
    {"normals", [](RenderSettings& s) { s.estimator.integrator = Integrator::Normals; }},
};

RenderSettings settings(uint32_t samples) {
    RenderSettings s;
    s.area.width = 48, s.area.height = 40;
    s.budget.mostSamplesPerPixel = samples;
    s.estimator.maxBounces = 5;
    return s;
}

/// A picture that shows whether its bytes depend on how work is cut: a few hundred pixels, more
/// than the fewest lanes below, of some samples each. More would take longer where dispatches are
/// short.
RenderSettings cutSettings() {
    RenderSettings s = settings(4);
    s.area.width = 24, s.area.height = 20;
    s.estimator.branches = 2;
    return s;
}

Camera camera() {
    return lookingAt({0.3, 0.2, 0.95}, {-0.1, -0.2, -0.5}, 0.7);
}

class TexturedRoom : public DeviceTest, public testing::WithParamInterface<Mode> {};

TEST_P(TexturedRoom, KernelAndReferenceAgree) {
    const Scene scene = texturedRoom();
    RenderSettings s = settings(64);
    GetParam().change(s);
    expectKernelAndReferenceAgree(testDevice(), scene, camera(), s);
}

INSTANTIATE_TEST_SUITE_P(Modes, TexturedRoom, testing::ValuesIn(kModes),
                         [](const auto& mode) { return mode.param.name; });

struct Rule {
    const char* name;
    ReliefRule rule;
    bool shadows;
};
const Rule kRules[] = {{"flip", ReliefRule::Flip, true}, {"blacken", ReliefRule::Blacken, false}};

class ReliefRules : public DeviceTest, public testing::WithParamInterface<Rule> {};

Scene reliefRoom(const Rule& rule) {
    Scene scene = texturedRoom();
    for (Material& m : scene.materials) {
        m.reliefRule = rule.rule, m.reliefShadows = rule.shadows;
        for (TextureUse& use : m.textures)
            if (use.slot == TextureSlot::Normal) use.scale *= 2; // some face away
    }
    return scene;
}

TEST_P(ReliefRules, KernelAndReferenceAgree) {
    RenderSettings s = settings(64);
    expectKernelAndReferenceAgree(testDevice(), reliefRoom(GetParam()), camera(), s);
}

TEST_P(ReliefRules, BytesAreTheSameHoweverWorkIsCut) {
    const Scene scene = reliefRoom(GetParam());
    const RenderSettings s = cutSettings();
    const Film whole = renderOnDevice(testDevice(), scene, camera(), s);
    for (const KernelTuning& tuning :
         {KernelTuning{.fixedIterations = 1}, {.lanes = 100, .fixedIterations = 50}})
        expectSameBytes(whole, renderOnDevice(testDevice(), scene, camera(), s, tuning));
}

INSTANTIATE_TEST_SUITE_P(Rules, ReliefRules, testing::ValuesIn(kRules),
                         [](const auto& rule) { return rule.param.name; });

class TexturedRoomBytes : public DeviceTest {};

TEST_F(TexturedRoomBytes, AreTheSameHoweverWorkIsCut) {
    const Scene scene = texturedRoom();
    RenderSettings s = cutSettings();
    s.estimator.lightSamples = 2;
    const Film whole = renderOnDevice(testDevice(), scene, camera(), s);
    for (const KernelTuning& tuning : {KernelTuning{.fixedIterations = 1},
                                       {.fixedIterations = 7},
                                       {.lanes = 100, .fixedIterations = 50},
                                       {.workgroupSize = 24, .traversalSteps = 1},
                                       {.itemsPerDispatch = 7},
                                       {.texelFetch = false}}) {
        const Film cut = renderOnDevice(testDevice(), scene, camera(), s, tuning);
        expectSameBytes(whole, cut);
    }
}

} // namespace
} // namespace stromboli
