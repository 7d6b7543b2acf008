// Light samples that aim at portals, in pictures: a known answer, no bias for any portals, the same
// bytes however the work is cut, and less noise where light comes through a window.
#include "host/kernel/light_notes.hpp"
#include "host/kernel/light_table.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/read_scene.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

namespace stromboli {
namespace {

using namespace test;

/// Rectangles anywhere, of any size and direction, many of which overlap as seen from the room: the
/// window itself among them, cut in two that overlap.
Portals anyPortals() {
    Random random(23);
    Portals portals{{{{-1, -0.5f, -0.5f}, {0, 0.8f, 0}, {0, 0, 1}},
                     {{-1, -0.1f, -0.5f}, {0, 0.6f, 0}, {0, 0, 1}}},
                    0.7};
    while (portals.all.size() < kMostPortals) {
        const glm::vec3 normal = random.direction();
        const glm::vec3 a = glm::normalize(glm::cross(normal, random.direction()));
        portals.all.push_back({random.inCube(1.5f), random.uniform(0.1f, 2) * a,
                               random.uniform(0.1f, 2) * glm::cross(normal, a)});
    }
    return portals;
}

class PortalLight : public DeviceTest {
  protected:
    PortalLight() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 64;
        settings_.estimator.maxBounces = 3;
        settings_.estimator.aimsAtPortals = true;
    }

    Film pictureOf(const Scene& loaded, const Portals& portals, const KernelTuning& tuning = {}) {
        GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
        scene.portals = portals;
        VulkanBackend backend(testDevice(), scene, view_, settings_, tuning);
        EXPECT_EQ(backend.features()[SPEC_PORTALS], portals.all.size());
        return render(backend, settings_);
    }

    Camera view_ = kRoomView;
    RenderSettings settings_;
};

/// A ceiling lets the sky in through a rectangle, and all that is seen is the floor below, so wide
/// that the picture shows nothing else: where the camera looks straight down at its middle the
/// irradiance is the sky's radiance times the integral of cos^2 / distance^2 over the opening.
TEST_F(PortalLight, IsWhatAnOpeningLetsIn) {
    constexpr double kHeight = 2, kHalfX = 0.3, kHalfZ = 0.5, kAlbedo = 0.6, kSky = 3;
    scenes::SceneMaker b;
    b.quad({-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0}, b.add(scenes::diffuse(float(kAlbedo))));
    const uint32_t black = b.add(scenes::diffuse(0));
    const float h = float(kHeight), x = float(kHalfX), z = float(kHalfZ), far = 1000;
    b.quad({-far, h, -far}, {far - x, 0, 0}, {0, 0, 2 * far}, black);
    b.quad({x, h, -far}, {far - x, 0, 0}, {0, 0, 2 * far}, black);
    b.quad({-x, h, -far}, {2 * x, 0, 0}, {0, 0, far - z}, black);
    b.quad({-x, h, z}, {2 * x, 0, 0}, {0, 0, far - z}, black);
    const Portals opening{{{{-x, h, -z}, {2 * x, 0, 0}, {0, 0, 2 * z}}}, 0.75};
    double expected = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double u = kHalfX * (2 * (i + 0.5) / kSteps - 1),
                         v = kHalfZ * (2 * (k + 0.5) / kSteps - 1);
            const double d2 = u * u + v * v + kHeight * kHeight;
            expected += kHeight * kHeight / (d2 * d2);
        }
    expected *= 4 * kHalfX * kHalfZ / (kSteps * kSteps) * kSky * kAlbedo / std::numbers::pi;

    view_ = lookingAt({0, 1, 1e-3}, {0, 0, 0}, 0.002);
    settings_.area.width = settings_.area.height = 8;
    settings_.estimator.maxBounces = 1;
    settings_.budget.mostSamplesPerPixel = 4096;
    const auto expectKnown = [&](const Scene& scene, const Portals& portals, const char* what) {
        const Film film = pictureOf(scene, portals);
        double mean = 0, variance = 0;
        for (const PixelStatistics& p : film.pixels) {
            mean += p.mean.y / double(film.pixels.size());
            variance += p.m2.y / (double(p.count) * (p.count - 1));
        }
        const double deviation = std::sqrt(variance) / double(film.pixels.size());
        EXPECT_NEAR(mean, expected, 4.5 * deviation) << what; // beyond it once in 150,000
        EXPECT_LT(deviation, 0.002 * expected) << what;
    };
    Light sky;
    sky.kind = LightKind::Ambient;
    sky.color = glm::vec3(float(kSky));
    Scene constant = b.scene;
    constant.lights.push_back(sky);
    Scene picture = b.scene;
    picture.environment.emplace();
    picture.environment->width = 4, picture.environment->height = 2;
    picture.environment->radiance.assign(8, glm::vec3(float(kSky)));
    for (const DirectLight mode : {DirectLight::Lights, DirectLight::Mis}) {
        settings_.estimator.directLight = mode;
        expectKnown(constant, opening, "ambient light");
        expectKnown(picture, opening, "a picture");
    }
}

/// Independent samples, so that variances are right.
TEST_F(PortalLight, AnyPortalsHaveNoBias) {
    settings_.estimator.sampler = Sampler::Independent;
    const auto expectNoBias = [&](const Scene& scene, const std::string& what) {
        settings_.estimator.seed = 0;
        settings_.estimator.aimsAtPortals = false;
        const Film plain = pictureOf(scene, {});
        settings_.estimator.seed = 1;
        settings_.estimator.aimsAtPortals = true;
        expectAgreement(plain, pictureOf(scene, anyPortals()), what);
    };
    settings_.budget.mostSamplesPerPixel = 192;
    settings_.estimator.directLight = DirectLight::Lights; // bounces find nothing
    expectNoBias(roomWithWindow(1), "a room");
    settings_.budget.mostSamplesPerPixel = 96;
    settings_.estimator.directLight = DirectLight::Mis;
    settings_.estimator.branches = 4;
    settings_.estimator.lightSamples = 2;
    settings_.estimator.lightChoice = LightChoice::Each;
    expectNoBias(roomWithMore(1), "rough glass, each of two lights, branches");
    settings_.estimator.lightChoice = LightChoice::Automatic;
    settings_.estimator.branches = 1;
    settings_.estimator.lightSamples = 1;
    Scene ambient = roomWithWindow(1);
    ambient.environment.reset();
    ambient.lights.emplace_back().kind = LightKind::Ambient;
    ambient.lights.back().color = glm::vec3(1);
    expectNoBias(ambient, "ambient light");
}

/// A portal in the plane of a surface, or of a wall, faces points of it by rounding alone: both
/// densities that are weighted against each other have to see it alike. One portal, so that there
/// is no other one that these points aim at.
TEST_F(PortalLight, InThePlaneOfASurfaceHasNoBias) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    b.quad({-5, 0.1f, -5}, {0, 0, 10}, {10, 0, 0}, white);
    view_ = lookingAt({0, 2, 2}, {0, 0.1, 0}, 0.5);
    const auto brightness = [&](const Scene& scene, const Portals& portals) {
        settings_.estimator.aimsAtPortals = !portals.all.empty();
        double mean = 0;
        for (const PixelStatistics& p : pictureOf(scene, portals).pixels)
            mean += p.mean.y;
        return mean;
    };
    const Portals inFloor{{{{-2, 0.1f, -2}, {0, 0, 4}, {4, 0, 0}}}, 0.75};
    Scene constant = b.scene;
    constant.lights.emplace_back().kind = LightKind::Ambient;
    constant.lights.back().color = glm::vec3(1);
    EXPECT_NEAR(brightness(constant, inFloor) / brightness(constant, {}), 1, 1e-3);
    Scene picture = b.scene;
    picture.environment = roughSky();
    picture.environment->radiance.assign(picture.environment->radiance.size(), glm::vec3(1));
    EXPECT_NEAR(brightness(picture, inFloor) / brightness(picture, {}), 1, 5e-3);
    // The wall of the window, seen from within.
    view_ = lookingAt({0.9, 0.1, 0.7}, {-1, 0.1, 0.7}, 0.2);
    settings_.budget.mostSamplesPerPixel = 256;
    const Scene room = roomWithWindow(1);
    const Portals inWall{{{{-1, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1}}}, 0.75};
    EXPECT_NEAR(brightness(room, inWall) / brightness(room, {}), 1, 0.01);
}

/// The choice whether to aim uses up digits of a number by which the tables of the sky choose, to
/// the last one where few texels of a large picture have most of its light.
TEST_F(PortalLight, LeavesASunAsBrightAsItIs) {
    const TemporaryFolder folder;
    std::ofstream(folder / "sky.xml") << R"(<scene version="3.0.0">
        <emitter type="sunsky"><float name="turbidity" value="3"/><float name="sun_scale" value="6"/>
            <vector name="sun_direction" x="0.3" y="0.92" z="0.45"/><float name="sky_scale" value="6"/>
            <transform name="to_world"><rotate x="1" angle="-90"/></transform></emitter>
        <shape type="rectangle"/></scene>)";
    const Environment sky = *readScene(folder / "sky.xml").environment;
    const auto brightest =
        size_t(std::ranges::max_element(sky.radiance, {}, &glm::vec3::y) - sky.radiance.begin());
    const double polar = std::numbers::pi * (double(brightest / sky.width) + 0.5) / sky.height;
    const double turn = 2 * std::numbers::pi * (double(brightest % sky.width) + 0.5) / sky.width;
    // Where the sun shines through a roof 4 m above the origin (shaders/lights/environment.glsl).
    const auto x = float(-4 * std::tan(polar) * std::sin(turn)),
               z = float(4 * std::tan(polar) * std::cos(turn));
    scenes::SceneMaker b;
    b.scene.environment = sky;
    b.quad({-10, 0, -10}, {0, 0, 20}, {20, 0, 0}, b.add(scenes::diffuse(0.5f)));
    const uint32_t roof = b.add(scenes::diffuse(0));
    b.quad({-50, 4, -50}, {x + 48.5f, 0, 0}, {0, 0, 100}, roof);
    b.quad({x + 1.5f, 4, -50}, {48.5f - x, 0, 0}, {0, 0, 100}, roof);
    b.quad({x - 1.5f, 4, -50}, {3, 0, 0}, {0, 0, z + 48.5f}, roof);
    b.quad({x - 1.5f, 4, z + 1.5f}, {3, 0, 0}, {0, 0, 48.5f - z}, roof);
    const Portals hole{{{{x - 1.5f, 4, z - 1.5f}, {3, 0, 0}, {0, 0, 3}}}, 0.75};
    view_ = lookingAt({0, 3, 1e-2}, {0, 0, 0}, 0.7);
    settings_.area.width = 32, settings_.area.height = 18;
    settings_.estimator.maxBounces = 1;
    settings_.budget.mostSamplesPerPixel = 4096;
    const auto brightness = [&](const Portals& portals) {
        settings_.estimator.aimsAtPortals = !portals.all.empty();
        double mean = 0;
        for (const PixelStatistics& p : pictureOf(b.scene, portals).pixels)
            mean += p.mean.y;
        return mean;
    };
    EXPECT_NEAR(brightness(hole) / brightness({}), 1, 0.002);
}

TEST_F(PortalLight, HasLessNoiseThroughAWindow) {
    const Scene scene = roomWithWindow(0.5f);
    settings_.estimator.aimsAtPortals = false;
    const Film plain = pictureOf(scene, {});
    settings_.estimator.aimsAtPortals = true;
    const Film aimed = pictureOf(scene, findPortals(buildWideBvh(scene), kRoomView, 1));
    double before = 0, after = 0;
    for (size_t i = 0; i < plain.pixels.size(); ++i) {
        before += plain.pixels[i].m2.y;
        after += aimed.pixels[i].m2.y;
    }
    EXPECT_LT(after, before / 3);
}

TEST_F(PortalLight, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = roomWithWindow(0.7f);
    const Portals portals = anyPortals();
    settings_.budget.mostSamplesPerPixel = 4;
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, portals, tuning); });
}

/// Where portals are aimed at, no guide is read; and a picture does not depend on the one before.
TEST_F(PortalLight, ComesBeforeGuiding) {
    const Scene loaded = roomWithWindow(0.7f);
    settings_.budget.mostSamplesPerPixel = 2;
    settings_.estimator.guidesLight = true;
    GpuScene scene = packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
    scene.guide = guideThatPays(loaded, scene, kRoomView, false);
    VulkanBackend backend(testDevice(), scene, kRoomView, settings_);
    EXPECT_NE(backend.features()[SPEC_GUIDES_LIGHT], 0u) << "there is no portal";
    scene.portals = anyPortals();
    backend.setPicture(kRoomView, settings_);
    EXPECT_EQ(backend.features()[SPEC_GUIDES_LIGHT], 0u);
    const Film after = render(backend, settings_);
    EXPECT_TRUE(sameStatistics(pictureOf(loaded, anyPortals()), after));
}

} // namespace
} // namespace stromboli
