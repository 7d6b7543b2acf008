// Shadow catchers, on the reference: what is behind the picture looks as if the objects stood on
// it.
#include "host/core/error.hpp"
#include "host/engine/shadow_catcher.hpp"
#include "scene/add_ground.hpp"
#include "tests/engine/engine_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli {
namespace {

using namespace test;

const DeviceRequest kByReference{.backend = BackendChoice::Reference};

/// The material shines by a texture, as objects do and lamps do not.
void letGlow(Scene& scene, size_t material) {
    scene.images.push_back({"white", 1, 1, TexelFormat::Rgba8, {0xFFFFFFFFu}});
    scene.textures.push_back({});
    scene.materials[material].emission = glm::vec3(1);
    scene.materials[material].textures.push_back({TextureSlot::Emission});
}

FloatImage picture(const Scene& scene, const RenderRequest& request) {
    RenderSession session(kByReference);
    session.begin(std::make_shared<const Scene>(scene), request);
    session.run();
    return session.pixels();
}

TEST(ShadowCatcher, OnItsOwnColourIsThePictureWithTheFloor) {
    Scene scene = boardOverFloor({0.9F, 0.2F, 0.1F}); // its light reddens the floor
    addSky(scene);
    RenderRequest request = fromAbove(256);
    request.background = Background{1, 1, {glm::vec3(kFloorAlbedo)}}; // of the floor by itself
    const FloatImage whole = picture(scene, request);
    request.shadowCatcher = "floor";
    const FloatImage caught = picture(scene, request);
    for (const char* channel : {"R", "G", "B"}) {
        const std::vector<float>&a = whole.channels.at(channel), &b = caught.channels.at(channel);
        // Some 3 % noise in a pixel of either picture: four standard errors of their difference.
        double sum = 0, difference = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            EXPECT_NEAR(a[i], b[i], 0.07) << channel << " of pixel " << i;
            sum += double(a[i]), difference += double(b[i] - a[i]);
        }
        EXPECT_NEAR(difference / sum, 0, 0.01) << channel;
    }
    const std::vector<float>& red = whole.channels.at("R");
    EXPECT_LT(*std::ranges::min_element(red), 0.4F) << "the floor is shaded";
}

TEST(ShadowCatcher, CatchesNothingWhereObjectsChangeNothing) {
    Scene scene = boardOverFloor(glm::vec3(0)); // it scatters nothing
    addSun(scene);
    RenderRequest request = fromAbove(4);
    request.shadowCatcher = "grey"; // a material
    const FloatImage caught = picture(scene, request);
    const std::vector<float>& alpha = caught.channels.at(kAlphaChannel);
    EXPECT_GT(std::ranges::count(alpha, 0.0F), 16 * 12 / 2)
        << "the light of most pixels is as it was";
    EXPECT_GT(std::ranges::count(alpha, 1.0F), 4) << "board, and a black shadow";
    for (const float red : caught.channels.at("R"))
        EXPECT_EQ(red, 0) << "neither a black board nor its shadow shines";
}

TEST(ShadowCatcher, WhatObjectsShineIsAdded) {
    Scene scene = boardOverFloor(glm::vec3(0));
    letGlow(scene, 1);
    RenderRequest request = fromAbove(256);
    request.background = Background{1, 1, {glm::vec3(0)}};
    const FloatImage whole = picture(scene, request);
    request.shadowCatcher = "floor";
    const FloatImage caught = picture(scene, request);
    double sum = 0, difference = 0;
    for (size_t i = 0; i < whole.channels.at("R").size(); ++i)
        sum += double(whole.channels.at("R")[i]),
            difference += double(caught.channels.at("R")[i] - whole.channels.at("R")[i]);
    EXPECT_GT(sum, 1);
    EXPECT_NEAR(difference / sum, 0, 0.02);
}

TEST(ShadowCatcher, PicturesOfASessionAreThoseOfSessionsOfTheirOwn) {
    Scene scene = boardOverFloor(glm::vec3(0.5));
    addSky(scene);
    const auto shared = std::make_shared<const Scene>(scene);
    RenderRequest request = fromAbove(4);
    request.shadowCatcher = "floor";
    RenderSession session(kByReference);
    session.begin(shared, request);
    session.run();
    CameraRequest other = request.camera;
    other.from = glm::dvec3(1, 3, 2);
    session.moveCamera(other);
    session.run();
    request.camera = other;
    EXPECT_EQ(session.pixels().channels, picture(scene, request).channels);
}

/// --ground comes after the objects of the file.
TEST(ShadowCatcher, IsTheLastObjectOfItsName) {
    Scene scene = boardOverFloor(glm::vec3(0.5));
    scene.instances[0] = kGroundName;
    addGround(scene, {.isGiven = true});
    const Scene hidden = withoutCatcher(scene, kGroundName);
    const auto isHidden = [&](size_t triangle) {
        return hidden.materials[hidden.triangles[triangle].material].isHiddenFromCamera;
    };
    EXPECT_FALSE(isHidden(0)) << "the file's own";
    EXPECT_TRUE(isHidden(hidden.triangles.size() - 1));
}

/// Both pictures choose their lights alike: what the scene frames is the same.
TEST(ShadowCatcher, AloneHasTheSizeOfTheScene) {
    Scene scene = boardOverFloor(glm::vec3(0.5));
    const Bounds all = scene.framed(), alone = catcherAlone(scene, "floor").framed();
    EXPECT_EQ(all.lo, alone.lo);
    EXPECT_EQ(all.hi, alone.hi);
}

/// A catcher that glows by itself is no shadow of its own.
TEST(ShadowCatcher, OfAGlowingFloorCatchesNothingByItself) {
    Scene scene = boardOverFloor(glm::vec3(0));
    letGlow(scene, 0);
    for (const Material& m : catcherAlone(scene, "floor").materials)
        EXPECT_FALSE(m.emits());
}

/// Who looks between passes changes nothing.
TEST(ShadowCatcher, LookingChangesNothing) {
    Scene scene = boardOverFloor(glm::vec3(0.5));
    addSky(scene);
    RenderRequest request = fromAbove(64);
    request.budget.mostPathsPerPixel.reset();
    request.budget.meanPathsPerPixel = 64;
    request.shadowCatcher = "floor";
    request.background = Background{1, 1, {glm::vec3(0.25)}};
    const FloatImage unseen = picture(scene, request);
    RenderSession session(kByReference);
    session.begin(std::make_shared<const Scene>(scene), request);
    while (session.pass())
        static_cast<void>(session.pixels());
    EXPECT_EQ(session.pixels().channels, unseen.channels);
}

TEST(ShadowCatcher, IsFoundByItsName) {
    Scene scene = boardOverFloor(glm::vec3(0.5));
    EXPECT_NO_THROW(requireCatcher(scene, "floor"));
    EXPECT_THROW(requireCatcher(scene, "wall"), SceneError);
    scene.media.emplace_back();
    EXPECT_THROW(requireCatcher(scene, "floor"), SceneError);
}

/// The darkest channel says how much of what is behind is left; what others have more of is added.
TEST(ShadowCatcher, DarkensByTheDarkestChannel) {
    Film among, alone;
    among.pixels.resize(2), alone.pixels.resize(2);
    alone.pixels[0].mean = {0.5, 0.5, 0.4};
    among.pixels[0].mean = {0.1, 0.2, 0.4};
    alone.pixels[1].mean = {0.5, 0.5, 0.5};
    among.pixels[1].mean = {0.6, 0.7, 0.5};
    const float coverage[] = {1, 1};
    const CaughtLight caught = caughtLight(among, alone, {}, coverage);
    EXPECT_FLOAT_EQ(caught.clear[0], 0.2F);
    EXPECT_NEAR(glm::distance(caught.added[0], glm::vec3(0, 0.1, 0.32)), 0, 1e-6);
    EXPECT_FLOAT_EQ(caught.clear[1], 1);
    EXPECT_NEAR(glm::distance(caught.added[1], glm::vec3(0.1, 0.2, 0)), 0, 1e-6);
    const float half[] = {0.5, 0.5};
    EXPECT_FLOAT_EQ(caughtLight(among, alone, {}, half).clear[0], 0.6F);
    std::vector<float> alpha{0, 0.25F};
    addShadow(alpha, caught);
    EXPECT_FLOAT_EQ(alpha[0], 0.8F);
    EXPECT_FLOAT_EQ(alpha[1], 0.25F);
}

} // namespace
} // namespace stromboli
