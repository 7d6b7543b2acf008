// Light samples that go through clear glass: a known answer, no bias beside bounces that find the
// same light, less noise behind panes, the same bytes however the work is cut; and when the host
// has them go on.
#include "host/kernel/glass_before_lights.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/light_table.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stromboli {
namespace {

using namespace test;

enum class Glass { None, Pane, Slab, Ball, Prism, Globe };
enum class LampShape { Panel, Mesh, Sphere, Large };

struct GlassRoom {
    Glass glass = Glass::Pane;
    LampShape lamp = LampShape::Panel;
    MaterialKind floor = MaterialKind::Diffuse;
    float alpha = 0;      ///< of the floor's facets
    bool isGltfs = false; ///< the pane or slab is of glTF's model
    int panes = 1;        ///< one behind the other
    float opacity = 1;    ///< of the pane
    bool hasVeil = false; ///< something half there before the glass
};

Material glassOf(MaterialKind kind) {
    Material glass;
    glass.kind = kind;
    glass.ior = 1.5f;
    glass.transmittance = {0.9f, 0.7f, 0.8f};
    return glass;
}

/// Clear glass of glTF's model; of a volume, which absorbs.
Material gltfsGlass(bool isThin) {
    Material glass;
    glass.kind = MaterialKind::Principled;
    glass.principled = {.baseColor = {0.9f, 0.7f, 0.8f},
                        .metallic = 0,
                        .roughness = 0,
                        .transmission = 1,
                        .isThin = isThin,
                        .attenuationColor = {0.5f, 0.8f, 0.6f},
                        .attenuationDistance = 0.2f};
    return glass;
}

/// Across the room from wall to wall, the part with the lamp behind it.
void addGlass(scenes::SceneMaker& b, const GlassRoom& room) {
    const Glass glass = room.glass;
    const glm::vec3 y(0, 2, 0), z(0, 0, 2);
    const uint32_t solid =
        b.add(room.isGltfs ? gltfsGlass(false) : glassOf(MaterialKind::Dielectric));
    Material pane = room.isGltfs ? gltfsGlass(true) : glassOf(MaterialKind::ThinDielectric);
    if (room.panes > 1) pane.transmittance = glm::vec3(1);
    if (room.opacity < 1) pane.alphaMode = AlphaMode::Blend, pane.opacity = room.opacity;
    Material veil = scenes::diffuse(0.5f);
    veil.alphaMode = AlphaMode::Blend, veil.opacity = 0.4f;
    if (room.hasVeil) b.quad({0.1f, -1, -1}, y, z, b.add(veil));
    const uint32_t sheet = b.add(pane);
    for (int i = 0; glass == Glass::Pane && i < room.panes; ++i)
        b.quad({0.2f + 0.04f * float(i), -1, -1}, y, z, sheet);
    if (glass == Glass::Slab || glass == Glass::Prism) {
        b.quad({0.2f, -1, -1}, z, y, solid); // both faces turned away from the glass between
        const float slant = glass == Glass::Prism ? 0.3f : 0;
        b.quad({0.3f + slant, -1, -1}, {-slant, 2, 0}, z, solid);
    }
    if (glass == Glass::Ball) b.sphere({0.3f, 0, 0}, 0.4f, solid);
    if (glass == Glass::Globe) { // about the spherical lamp
        b.sphere({0.5f, 0.1f, 0.1f}, 0.45f, solid);
        Material hollow = glassOf(MaterialKind::Dielectric);
        hollow.ior = 1 / hollow.ior;
        b.sphere({0.5f, 0.1f, 0.1f}, 0.42f, b.add(hollow));
    }
}

void addLamp(scenes::SceneMaker& b, LampShape lamp) {
    const uint32_t shine = b.add(scenes::emissive(30));
    if (lamp == LampShape::Sphere) b.sphere({0.8f, 0.1f, 0.1f}, 0.1f, shine);
    if (lamp == LampShape::Large) b.sphere({0.5f, 0.1f, 0.1f}, 0.35f, shine);
    if (lamp == LampShape::Panel) b.quad({0.9f, -0.1f, -0.2f}, {0, 0, 0.3f}, {0, 0.3f, 0}, shine);
    if (lamp == LampShape::Mesh)
        b.triangle({0.9f, -0.3f, -0.2f}, {0.9f, -0.1f, 0.3f}, {0.8f, 0.3f, 0}, shine);
}

/// A closed box of side 2 about the origin.
Scene roomWithGlass(const GlassRoom& room) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    Material other = scenes::diffuse(0.6f);
    other.kind = room.floor;
    other.facets.alpha = glm::vec2(room.alpha);
    const glm::vec3 low(-1), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    b.quad(low, z, x, b.add(other));
    b.quad(low + y, x, z, white), b.quad(low, y, z, white), b.quad(low + x, z, y, white);
    b.quad(low, x, y, white), b.quad(low + z, y, x, white);
    addGlass(b, room);
    addLamp(b, room.lamp);
    return b.scene;
}

/// The room of window_room.hpp, with a pane in its window.
Scene glazedRoom(float window, MaterialKind kind = MaterialKind::ThinDielectric) {
    scenes::SceneMaker b;
    b.scene = roomWithWindow(window);
    const float h = window / 2;
    const uint32_t glass = b.add(glassOf(kind));
    b.quad({-1, -h, -h}, {0, window, 0}, {0, 0, window}, glass);
    if (kind == MaterialKind::Dielectric)
        b.quad({-1.02f, -h, -h}, {0, 0, window}, {0, window, 0}, glass);
    return b.scene;
}

const Camera kGlassView = lookingAt({-0.9, 0.5, 0.8}, {0, -0.4, -0.2}, 0.9);
class LightThroughGlass : public DeviceTest {
  protected:
    LightThroughGlass() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 64;
        settings_.estimator.maxBounces = 5;
    }

    Film pictureOf(const Scene& loaded, bool goesThrough, const KernelTuning& tuning = {},
                   const Portals& portals = {}) {
        GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
        scene.glassBeforeLights = goesThrough ? 1 : 0;
        scene.portals = portals;
        VulkanBackend backend(testDevice(), scene, view_, settings_, tuning);
        EXPECT_EQ(backend.features()[SPEC_LIGHT_THROUGH_GLASS], goesThrough ? 1u : 0u);
        return render(backend, settings_);
    }

    void expectNoBias(const Scene& scene, const std::string& what, const Portals& portals = {}) {
        settings_.estimator.sampler = Sampler::Independent; // so that variances are right
        settings_.estimator.seed = 0;
        const Film blocked = pictureOf(scene, false, {}, portals);
        settings_.estimator.seed = 1;
        expectAgreement(blocked, pictureOf(scene, true, {}, portals), what);
    }

    static double noiseOf(const Film& film) {
        double sum = 0;
        for (const auto& pixel : film.pixels)
            sum += pixel.m2.y;
        return sum;
    }

    Camera view_ = kGlassView;
    RenderSettings settings_;
};

/// What a sheet of index 1.5 lets through, with all reflections inside it.
double throughSheet(double cosine) {
    const double index = 1.5, t = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
    const double s = (cosine - index * t) / (cosine + index * t),
                 p = (index * cosine - t) / (index * cosine + t);
    const double r = (s * s + p * p) / 2;
    return 1 - 2 * r / (1 + r);
}

/// A panel shines through a sheet of glass onto a floor that is all the camera sees: the irradiance
/// is the integral of T cos^2 / distance^2 over the panel, T being what the sheet lets through.
TEST_F(LightThroughGlass, IsWhatASheetLetsThrough) {
    constexpr double kHeight = 2, kHalfX = 0.3, kHalfZ = 0.5, kAlbedo = 0.6, kRadiance = 3;
    const float h = float(kHeight), x = float(kHalfX), z = float(kHalfZ);
    scenes::SceneMaker b;
    b.quad({-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0}, b.add(scenes::diffuse(float(kAlbedo))));
    b.quad({-x, h, -z}, {2 * x, 0, 0}, {0, 0, 2 * z}, b.add(scenes::emissive(float(kRadiance))));
    Material sheet = glassOf(MaterialKind::ThinDielectric);
    sheet.transmittance = glm::vec3(1);
    b.quad({-9, 1.5f, -9}, {18, 0, 0}, {0, 0, 18}, b.add(sheet));
    double expected = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double u = kHalfX * (2 * (i + 0.5) / kSteps - 1),
                         v = kHalfZ * (2 * (k + 0.5) / kSteps - 1);
            const double d2 = u * u + v * v + kHeight * kHeight;
            expected += throughSheet(kHeight / std::sqrt(d2)) * kHeight * kHeight / (d2 * d2);
        }
    expected *= 4 * kHalfX * kHalfZ / (kSteps * kSteps) * kRadiance * kAlbedo / std::numbers::pi;

    view_ = lookingAt({0, 1, 1e-3}, {0, 0, 0}, 0.002);
    settings_.area.width = settings_.area.height = 8;
    settings_.budget.mostSamplesPerPixel = 4096;
    for (const DirectLight mode : {DirectLight::Lights, DirectLight::Mis, DirectLight::MisAll}) {
        settings_.estimator.directLight = mode;
        settings_.estimator.maxBounces = 2;
        const Film film = pictureOf(b.scene, true);
        double mean = 0, variance = 0;
        for (const PixelStatistics& p : film.pixels) {
            mean += p.mean.y / double(film.pixels.size());
            variance += p.m2.y / (double(p.count) * (p.count - 1));
        }
        const double deviation = std::sqrt(variance) / double(film.pixels.size());
        EXPECT_NEAR(mean, expected, 4.5 * deviation) << int(mode); // beyond it once in 150,000
        EXPECT_LT(deviation, 0.002 * expected);
    }
}

TEST_F(LightThroughGlass, HasNoBias) {
    using enum MaterialKind;
    settings_.budget.mostSamplesPerPixel = 256;
    expectNoBias(roomWithGlass({}), "a pane");
    expectNoBias(roomWithGlass({.isGltfs = true}), "a pane of glTF's model");
    settings_.estimator.directLight = DirectLight::MisAll;
    expectNoBias(roomWithGlass({.glass = Glass::Slab, .lamp = LampShape::Mesh}), "a slab");
    expectNoBias(roomWithGlass({.glass = Glass::Slab, .isGltfs = true}), "one that absorbs");
    settings_.estimator.branches = 4;
    expectNoBias(roomWithGlass({.glass = Glass::Ball, .lamp = LampShape::Sphere}), "a ball");
    expectNoBias(roomWithGlass({.glass = Glass::Prism, .floor = Plastic, .alpha = 0.2f}),
                 "a prism, rough plastic");
    settings_.estimator.directLight = DirectLight::Lights;
    expectNoBias(roomWithGlass({.glass = Glass::Ball, .floor = Principled}),
                 "light samples alone, of glTF's materials");
    // Many branches end at the lamp, and others begin at the glass that it is seen through.
    expectNoBias(roomWithGlass({.glass = Glass::Globe, .lamp = LampShape::Large}), "a globe");
    // Paths that end with the pane, and those that have to be longer than most.
    settings_.estimator.directLight = DirectLight::Mis;
    settings_.estimator.maxBounces = 2;
    expectNoBias(roomWithGlass({.glass = Glass::Slab}), "few bounces");
    settings_.estimator.maxBounces = 5;
    expectNoBias(roomWithGlass({.glass = Glass::Slab, .hasVeil = true}), "behind a veil");
    expectNoBias(roomWithGlass({.panes = 2, .opacity = 0.5f}), "panes that are half there");
    settings_.estimator.maxBounces = 16;
    expectNoBias(roomWithGlass({.panes = 12}), "as many panes as light samples go through");
    expectNoBias(roomWithGlass({.panes = 13}), "more");
    settings_.estimator.maxBounces = 5;
    settings_.estimator.minBounce = 3;
    expectNoBias(roomWithGlass({}), "from the third bounce on");
}

/// The sky, as light samples find it by its picture, and where they aim at the window.
TEST_F(LightThroughGlass, OfTheSkyHasNoBias) {
    view_ = kRoomView;
    settings_.budget.mostSamplesPerPixel = 256;
    settings_.estimator.maxBounces = 4;
    for (const MaterialKind kind : {MaterialKind::ThinDielectric, MaterialKind::Dielectric}) {
        const Scene scene = glazedRoom(1, kind);
        settings_.estimator.aimsAtPortals = false;
        expectNoBias(scene, "a glazed window");
        settings_.estimator.aimsAtPortals = true;
        expectNoBias(scene, "one that is aimed at",
                     {{{{-1, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1}}}, 0.75});
    }
}

TEST_F(LightThroughGlass, HasLessNoise) {
    view_ = lookingAt({-0.3, 0.6, 0}, {-0.9, -0.9, 0}, 0.7); // neither the glass nor the lamp
    for (const Glass glass : {Glass::Pane, Glass::Slab}) {
        const Scene scene = roomWithGlass({.glass = glass});
        EXPECT_LT(noiseOf(pictureOf(scene, true)), noiseOf(pictureOf(scene, false)) / 2);
    }
    view_ = kRoomView;
    const Scene scene = glazedRoom(0.5f);
    const Film blocked = pictureOf(scene, false);
    settings_.estimator.aimsAtPortals = true;
    const GpuScene packed = packScene(scene, buildWideBvh(scene), lightSelection({}));
    const Portals portals = findPortals(packed.bvh, view_, 1, clearGlassOf(packed));
    ASSERT_EQ(portals.all.size(), 1u) << "rays go through the pane to find it";
    EXPECT_LT(noiseOf(pictureOf(scene, true, {}, portals)), noiseOf(blocked) / 4);
    EXPECT_TRUE(findPortals(packed.bvh, view_, 1).all.empty()) << "they end at it";
}

TEST_F(LightThroughGlass, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = roomWithGlass({.glass = Glass::Ball});
    settings_.budget.mostSamplesPerPixel = 8;
    settings_.estimator.branches = 4;
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, true, tuning); });
}

/// What a sample on its way through glass brings is looked up when it has found the sky, some
/// passes later.
TEST_F(LightThroughGlass, OfTheSkyHasTheSameBytesHoweverTheWorkIsCut) {
    view_ = kRoomView;
    const Scene scene = glazedRoom(1, MaterialKind::Dielectric);
    settings_.budget.mostSamplesPerPixel = 8;
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, true, tuning); });
}

// --- When
// ------------------------------------------------------------------------------------------

double shareOf(const Scene& scene, const Camera& view = kGlassView) {
    return shareThroughGlass(scene, packScene(scene, buildWideBvh(scene), lightSelection({})),
                             view);
}

TEST(GlassBeforeLights, IsTheShareOfLightThatComesThroughIt) {
    EXPECT_EQ(shareOf(roomWithGlass({.glass = Glass::None})), 0);
    const double pane = shareOf(roomWithGlass({}));
    EXPECT_GT(pane, 0.2) << "of what is before the pane all, and nothing of what is behind";
    EXPECT_LT(pane, 0.8);
    EXPECT_NEAR(shareOf(roomWithGlass({.glass = Glass::Slab})), pane, 0.1);
    const double ball = shareOf(roomWithGlass({.glass = Glass::Ball}));
    EXPECT_GT(ball, 0.001);
    EXPECT_LT(ball, pane / 2) << "most of what meets it is bent away from the lamp";
    EXPECT_EQ(shareOf(roomWithWindow(1), kRoomView), 0);
    EXPECT_EQ(shareOf(glazedRoom(1), kRoomView), 1);
    EXPECT_EQ(shareOf(glazedRoom(1, MaterialKind::Dielectric), kRoomView), 1);
}

TEST(GlassBeforeLights, HasToBeEnoughOfIt) {
    const Scene scene = roomWithGlass({});
    GpuScene packed = packScene(scene, buildWideBvh(scene), lightSelection({}));
    Estimator estimator;
    EXPECT_FALSE(lightsThroughGlass(packed, estimator)) << "packScene() leaves that to others";
    packed.glassBeforeLights = 0.01;
    EXPECT_FALSE(lightsThroughGlass(packed, estimator));
    packed.glassBeforeLights = 0.03;
    EXPECT_TRUE(lightsThroughGlass(packed, estimator));
    estimator.directLight = DirectLight::Bsdf;
    EXPECT_FALSE(lightsThroughGlass(packed, estimator)) << "no lamp is sampled";
}

} // namespace
} // namespace stromboli
