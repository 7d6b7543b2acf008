// What a lens makes sharp: a distance, what is in the middle, or what a pixel shows.

#include "host/core/error.hpp"
#include "scene/camera/focus.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

/// A wall across the view at z = -depth that covers x from `left` to `right`.
void addWall(Scene& scene, float depth, float left, float right, uint32_t material = 0) {
    const auto first = uint32_t(scene.positions.size());
    for (const glm::vec2& p : {glm::vec2(left, -50), {right, -50}, {right, 50}, {left, 50}})
        scene.positions.emplace_back(p.x, p.y, -depth);
    scene.triangles.push_back({{first, first + 1, first + 2}, {}, material, 0});
    scene.triangles.push_back({{first, first + 2, first + 3}, {}, material, 0});
}

/// From the origin along -z: a wall 5 m away on the right, 2 m away on the left.
Scene twoWalls() {
    Scene scene;
    scene.file = "a.gltf";
    scene.materials.resize(1);
    addWall(scene, 5, 0, 50);
    addWall(scene, 2, -50, 0);
    return scene;
}

CameraRequest lens(std::optional<Focus> focus) {
    CameraRequest request;
    request.from = glm::dvec3(0);
    request.at = glm::dvec3(0, 0, -1);
    request.aperture = 0.01;
    request.focus = focus;
    return request;
}

double focusOf(const Scene& scene, const CameraRequest& request) {
    return makeCamera(scene, request, 40, 30).focusDistance;
}

TEST(Focus, APixelIsSharpAtTheDepthOfWhatItShows) {
    EXPECT_DOUBLE_EQ(focusOf(twoWalls(), lens(Focus::onPixel({39, 0}))), 5);
    EXPECT_DOUBLE_EQ(focusOf(twoWalls(), lens(Focus::onPixel({0, 29}))), 2);
    EXPECT_DOUBLE_EQ(focusOf(twoWalls(), lens(Focus::onPixel({20, 15}))), 5);
    EXPECT_DOUBLE_EQ(focusOf(twoWalls(), lens(Focus::onPixel({19, 15}))), 2);
    EXPECT_DOUBLE_EQ(focusOf(twoWalls(), lens(3.0)), 3);
}

TEST(Focus, TheMiddleIsWhatMostOfItShows) {
    Scene scene;
    scene.materials.resize(1);
    addWall(scene, 7, -50, 50);
    addWall(scene, 3, -0.1F, 0.02F); // a post in front, in the middle
    EXPECT_DOUBLE_EQ(focusOf(scene, lens(Focus::onMiddle())), 7);
    addWall(scene, 4, -0.4F, 0.4F);
    EXPECT_DOUBLE_EQ(focusOf(scene, lens(Focus::onMiddle())), 4);
    EXPECT_DOUBLE_EQ(focusOf(scene, lens(std::nullopt)), 4) << "a lens alone focuses by itself";
}

TEST(Focus, LooksElsewhereWhereTheMiddleIsEmpty) {
    Scene scene;
    scene.materials.resize(1);
    addWall(scene, 6, 2, 50);
    EXPECT_DOUBLE_EQ(focusOf(scene, lens(Focus::onMiddle())), 6);
}

TEST(Focus, WithNothingThereIsFarAway) {
    Scene scene;
    const Camera camera = makeCamera(scene, lens(Focus::onMiddle()), 40, 30);
    EXPECT_LT(2 * camera.lensRadius / camera.focusDistance, 2 * camera.halfHeight / 30 / 15);
}

TEST(Focus, GoesThroughWhatIsNotThere) {
    Scene scene = twoWalls();
    scene.materials.resize(3);
    scene.materials[1].isHiddenFromCamera = true;
    scene.materials[2].alphaMode = AlphaMode::Blend;
    scene.materials[2].opacity = 0.4F;
    addWall(scene, 1, -50, 50, 1);
    addWall(scene, 1.5F, -50, 50, 2);
    EXPECT_DOUBLE_EQ(focusOf(scene, lens(Focus::onPixel({39, 0}))), 5);
    scene.materials[2].opacity = 0.6F;
    EXPECT_DOUBLE_EQ(focusOf(scene, lens(Focus::onPixel({39, 0}))), 1.5);
}

TEST(Focus, MeetsSpheresAndWhatIsPlaced) {
    Scene scene;
    scene.materials.resize(1);
    scene.spheres.push_back({{0, 0, -10}, 2, 0, 0});
    EXPECT_NEAR(focusOf(scene, lens(Focus::onPixel({20, 15}))), 8, 0.01);
    Scene placed;
    placed.materials.resize(1);
    addWall(placed, 5, -50, 50);
    placed.prototypes.push_back({0, 2});
    Placement further;
    further.toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, -4}}};
    placed.placements.push_back(further);
    EXPECT_DOUBLE_EQ(focusOf(placed, lens(Focus::onPixel({20, 15}))), 9);
}

TEST(Focus, WhereAPixelShowsNothingIsAnError) {
    EXPECT_THROW(makeCamera(Scene{}, lens(Focus::onPixel({20, 15})), 40, 30), SceneError);
    EXPECT_THROW(makeCamera(twoWalls(), lens(Focus::onPixel({40, 0})), 40, 30), SceneError);
}

TEST(Focus, NeedsALens) {
    CameraRequest request = lens(Focus::onMiddle());
    request.aperture = 0;
    EXPECT_THROW(makeCamera(twoWalls(), request, 40, 30), SceneError);
}

TEST(Focus, ChangesTheLensOfAFile) {
    Scene scene = twoWalls();
    FileCamera file;
    file.lensRadius = 0.1, file.focusDistance = 3;
    scene.cameras.push_back(file);
    CameraRequest request(CameraChoice::File);
    EXPECT_DOUBLE_EQ(focusOf(scene, request), 3);
    request.focus = Focus::onPixel({39, 0});
    const Camera camera = makeCamera(scene, request, 40, 30);
    EXPECT_DOUBLE_EQ(camera.focusDistance, 5);
    EXPECT_DOUBLE_EQ(camera.lensRadius, 0.1);
}

} // namespace
} // namespace stromboli::test
