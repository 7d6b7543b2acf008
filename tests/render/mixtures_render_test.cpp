// Pictures of a room with mixtures of all sorts: evaluated together or drawn, of two materials or
// more, with shares and colours by textures. The kernel and the reference agree on it (z-tests with
// a family-wise error of 1e-4 a mode, fixed seeds), and the kernel gives the same bytes however its
// work is cut.
#include "host/core/random.hpp"
#include "tests/analytic/textured.hpp"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

VertexAttributes byPlace(const glm::vec3& p) {
    VertexAttributes a;
    a.uv[0] = {p.x + 0.3f * p.z, 0.7f * p.z - p.y};
    a.color = glm::vec4(1);
    return a;
}

class RoomMaker {
  public:
    RoomMaker() {
        Random random(5);
        std::vector<glm::vec4> noise, bumps;
        for (int i = 0; i < 64; ++i) {
            const auto u = [&] { return float(random.uniform()); };
            noise.emplace_back(u(), u(), u(), 1);
            bumps.emplace_back(0.3f + 0.4f * u(), 0.3f + 0.4f * u(), 1, 1);
        }
        paper_ = t_.texture({.image = t_.bytes(8, 8, noise), .srgb = true});
        spots_ = t_.texture({.image = t_.bytes(8, 8, noise), .nearest = true});
        normals_ = t_.texture(t_.bytes(8, 8, bumps));
        b_.box({-1, -1, -1}, {1, 1, 1}, b_.add(diffuse(0.7f)), true);
        t_.attributes(12, byPlace);
        b_.quad({-0.4f, 0.95f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, b_.add(emissive(8, false)));
        t_.attributes(2, byPlace);
    }

    /// Each takes the place of the one before it by that one's share.
    uint32_t mixture(std::vector<Material> parts) {
        uint32_t next = kNoMaterial;
        for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
            part->other = next;
            next = b_.add(*part);
        }
        return next;
    }

    void quad(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b, uint32_t material) {
        b_.quad(corner, a, b, material);
        t_.attributes(2, byPlace);
    }

    static Material shared(Material m, float share) {
        m.otherShare = share;
        return m;
    }
    Material with(Material m, TextureSlot slot, uint32_t texture) {
        m.textures.push_back({.slot = slot, .texture = texture});
        return m;
    }

    Scene make() {
        // A picture of the share, and colours by pictures of their own.
        Material painted = with(shared(diffuse(0.8f), 1), TextureSlot::BlendShare, spots_);
        painted = with(painted, TextureSlot::BaseColor, paper_);
        quad({-0.9f, -0.9f, -0.9f}, {1.8f, 0, 0}, {0, 1.2f, 0}, mixture({painted, metal(0.3f)}));
        // Narrow facets, whose light the reference leaves to bounces, beside wide ones.
        quad({-0.9f, -0.95f, -0.8f}, {0, 0, 1}, {1, 0.1f, 0},
             mixture({shared(diffuse(0.3f), 0.5f), metal(0.1f)}));
        // Lit from both sides.
        Material frosted = glass(1.5f);
        frosted.facets.alpha = glm::vec2(0.4f);
        quad({-0.8f, -0.6f, 0.1f}, {0.6f, 0, 0.2f}, {0, 0.8f, 0},
             mixture({shared(frosted, 0.6f), diffuse(0.6f)}));
        // One map for both, and one map for one: the latter is drawn.
        const Material bumpy = with(diffuse(0.7f), TextureSlot::Normal, normals_);
        const Material bumpyMetal = with(metal(0.4f), TextureSlot::Normal, normals_);
        quad({0.1f, -0.7f, 0}, {0.7f, 0, -0.3f}, {0, 0.6f, 0},
             mixture({shared(bumpy, 0.5f), bumpyMetal}));
        quad({0.1f, 0, 0}, {0.7f, 0, -0.3f}, {0, 0.6f, 0},
             mixture({shared(diffuse(0.7f), 0.5f), bumpyMetal}));
        // Partly there, of three; and another mixture on the other side.
        Material veil = shared(diffuse(0.9f), 0.5f);
        veil.alphaMode = AlphaMode::Blend;
        veil.opacity = 0.6f;
        Material mirror;
        mirror.kind = MaterialKind::Mirror;
        quad({-0.3f, -0.2f, -0.2f}, {0.5f, 0, 0.1f}, {0, 0.7f, 0},
             mixture({veil, shared(metal(0.5f), 0.5f), mirror}));
        Material front = shared(diffuse(0.2f), 1);
        front.otherPlace = OtherPlace::Behind;
        quad({0.5f, -0.9f, 0.3f}, {0, 0.7f, 0}, {0.3f, 0, 0.1f},
             mixture({front, shared(metal(0.6f), 0.4f), diffuse(0.9f)}));
        Material coated;
        coated.kind = MaterialKind::Principled;
        coated.principled = {.metallic = 0.2f, .roughness = 0.5f, .clearcoat = 0.7f};
        b_.sphere({-0.5f, -0.6f, -0.4f}, 0.25f, mixture({shared(coated, 0.5f), glass(1.5f)}));
        t_.attributes(0, {});
        return b_.scene;
    }

  private:
    SceneMaker b_;
    TextureMaker t_{b_.scene};
    uint32_t paper_ = 0, spots_ = 0, normals_ = 0;
};

struct MixtureMode {
    const char* name;
    void (*change)(RenderSettings&);
};
const MixtureMode kMixtureModes[] = {
    {"mis", [](RenderSettings&) {}},
    {"misAll", [](RenderSettings& s) { s.estimator.directLight = DirectLight::MisAll; }},
    {"lights", [](RenderSettings& s) { s.estimator.directLight = DirectLight::Lights; }},
    {"hemisphere", [](RenderSettings& s) { s.estimator.directLight = DirectLight::Hemisphere; }},
    {"bsdf", [](RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }},
    {"branches",
     [](RenderSettings& s) { // 96 branches a pixel: more than other modes have paths
         s.estimator.branches = 3;
         s.budget.mostSamplesPerPixel /= 2;
     }},
};

RenderSettings mixtureSettings(uint32_t samples) {
    RenderSettings s;
    s.area.width = 48, s.area.height = 40;
    s.budget.mostSamplesPerPixel = samples;
    s.estimator.maxBounces = 5;
    return s;
}

/// A picture that shows whether its bytes depend on how work is cut: a few hundred pixels, more
/// than the fewest lanes below, of some samples each. More would take longer where dispatches are
/// short.
RenderSettings cutMixtureSettings() {
    RenderSettings s = mixtureSettings(4);
    s.area.width = 24, s.area.height = 20;
    s.estimator.branches = 2;
    return s;
}

Camera mixtureCamera() {
    return lookingAt({0.3, 0.2, 0.95}, {-0.1, -0.2, -0.5}, 0.7);
}

class MixtureRoom : public DeviceTest, public testing::WithParamInterface<MixtureMode> {};

TEST_P(MixtureRoom, KernelAndReferenceAgree) {
    RenderSettings s = mixtureSettings(64);
    GetParam().change(s);
    expectKernelAndReferenceAgree(testDevice(), RoomMaker().make(), mixtureCamera(), s);
}

INSTANTIATE_TEST_SUITE_P(Modes, MixtureRoom, testing::ValuesIn(kMixtureModes),
                         [](const auto& mode) { return mode.param.name; });

class MixtureRoomBytes : public DeviceTest {};

TEST_F(MixtureRoomBytes, AreTheSameHoweverWorkIsCut) {
    const Scene scene = RoomMaker().make();
    RenderSettings s = cutMixtureSettings();
    s.estimator.lightSamples = 2;
    const Film whole = renderOnDevice(testDevice(), scene, mixtureCamera(), s);
    for (const KernelTuning& tuning : {KernelTuning{.fixedIterations = 1},
                                       {.lanes = 100, .fixedIterations = 50},
                                       {.texelFetch = false},
                                       {.scheduler = PathScheduler::Wavefront}})
        expectSameBytes(whole, renderOnDevice(testDevice(), scene, mixtureCamera(), s, tuning));
}

} // namespace
} // namespace stromboli
