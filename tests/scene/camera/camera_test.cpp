// How a file's camera fits pictures of any shape.

#include "scene/camera/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

Scene sceneWith(const FileCamera& camera) {
    Scene scene;
    scene.cameras.push_back(camera);
    return scene;
}

Camera fileCamera(const FileCamera& camera, uint32_t width, uint32_t height) {
    return makeCamera(sceneWith(camera), CameraChoice::File, width, height, false);
}

TEST(FileCamera, BothExtentsAreSeenAndMoreOnTheLongerSide) {
    FileCamera file;
    file.halfWidth = 0.6, file.halfHeight = 0.3;
    const Camera same = fileCamera(file, 200, 100);
    EXPECT_DOUBLE_EQ(same.halfWidth, 0.6);
    EXPECT_DOUBLE_EQ(same.halfHeight, 0.3);
    const Camera wide = fileCamera(file, 400, 100);
    EXPECT_DOUBLE_EQ(wide.halfWidth, 1.2);
    EXPECT_DOUBLE_EQ(wide.halfHeight, 0.3);
    const Camera high = fileCamera(file, 100, 100);
    EXPECT_DOUBLE_EQ(high.halfWidth, 0.6);
    EXPECT_DOUBLE_EQ(high.halfHeight, 0.6);
}

TEST(FileCamera, OneExtentIsKeptInPicturesOfAnyShape) {
    FileCamera file;
    file.halfWidth = 0.5;
    EXPECT_DOUBLE_EQ(fileCamera(file, 200, 100).halfHeight, 0.25);
    EXPECT_DOUBLE_EQ(fileCamera(file, 100, 200).halfWidth, 0.5);
    EXPECT_DOUBLE_EQ(fileCamera(file, 100, 200).halfHeight, 1);
    file.halfHeight = 0.5, file.halfWidth.reset();
    EXPECT_DOUBLE_EQ(fileCamera(file, 200, 100).halfWidth, 1);
    EXPECT_DOUBLE_EQ(fileCamera(file, 100, 200).halfHeight, 0.5);
}

TEST(FileCamera, ExtentsGiveThePictureItsDefaultShape) {
    FileCamera file;
    file.halfWidth = 0.5, file.halfHeight = 0.25;
    const PictureSize size = defaultPictureSize(sceneWith(file), CameraChoice::File, false);
    EXPECT_EQ(size.width, 800u);
    EXPECT_EQ(size.height, 400u);
    file.halfHeight.reset();
    EXPECT_EQ(defaultPictureSize(sceneWith(file), CameraChoice::File, false).height, 600u);
}

TEST(FileCamera, PoseAndDepthRangeAreTheFiles) {
    FileCamera file;
    file.projection = Projection::Orthographic;
    file.position = {1, 2, 3};
    file.right = {0, 0, -1}, file.up = {0, 1, 0}, file.back = {1, 0, 0};
    file.halfWidth = 2, file.halfHeight = 1;
    file.nearDistance = 0.5, file.farDistance = 7;
    const Camera camera = fileCamera(file, 200, 100);
    EXPECT_TRUE(camera.orthographic);
    EXPECT_EQ(camera.position, file.position);
    EXPECT_EQ(camera.right, file.right);
    EXPECT_EQ(camera.up, file.up);
    EXPECT_EQ(camera.back, file.back);
    EXPECT_EQ(camera.halfWidth, 2);
    EXPECT_EQ(camera.nearDistance, 0.5);
    EXPECT_EQ(camera.farDistance, 7);
}

TEST(FramedCamera, LooksFromTheDirectionOfThePointAheadOfTheFilesCamera) {
    FileCamera file;
    file.halfWidth = file.halfHeight = 0.5;
    file.position = {0, 0, 5};
    file.pointAhead = {3, 0, 4};
    Scene scene = sceneWith(file);
    scene.framing = Bounds{glm::vec3(-1), glm::vec3(1)};
    const Camera camera = makeCamera(scene, CameraChoice::Frame, 800, 600, false);
    const double distance = 1.5 * std::sqrt(12.0);
    EXPECT_NEAR(camera.position.x, distance * 0.6, 1e-12);
    EXPECT_NEAR(camera.position.y, 0, 1e-12);
    EXPECT_NEAR(camera.position.z, distance * 0.8, 1e-12);
}

} // namespace
} // namespace stromboli::test
