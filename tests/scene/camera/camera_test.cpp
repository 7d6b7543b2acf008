// How a file's camera fits pictures of any shape.

#include "host/cs184/cs184.hpp"
#include "scene/camera/camera.hpp"

#include "host/core/error.hpp"

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
    return makeCamera(sceneWith(camera), CameraChoice::File, width, height);
}

/// A scene with something in it: a triangle about (2, 0, 0).
Scene withTriangle() {
    Scene scene;
    scene.file = "a.gltf";
    scene.positions = {{1, -1, 0}, {3, -1, 0}, {2, 1, 0}};
    scene.triangles.push_back({{0, 1, 2}, {}, 0, 0});
    return scene;
}

TEST(Turntable, TurnsTheCameraAboutTheMiddle) {
    CameraRequest request;
    request.from = glm::dvec3(2, 3, 5);
    const Camera before = makeCamera(withTriangle(), request, 200, 100);
    request.turn = 1.5707963267948966;
    const Camera camera = makeCamera(withTriangle(), request, 200, 100);
    // From (2, 0, 0) the camera is at (0, 3, 5); a quarter of a turn to the left leads +z to +x.
    EXPECT_LT(glm::distance(camera.position, glm::dvec3(7, 3, 0)), 1e-12);
    const glm::dvec3 toMiddle = glm::dvec3(2, 0, 0) - camera.position;
    EXPECT_LT(glm::distance(-camera.back, glm::normalize(toMiddle)), 1e-12);
    EXPECT_LT(glm::distance(glm::cross(camera.right, camera.up), camera.back), 1e-12);
    EXPECT_EQ(camera.halfWidth, before.halfWidth);
    request.turn = 0;
    EXPECT_EQ(makeCamera(withTriangle(), request, 200, 100).position, before.position);
}

TEST(StatedView, IsInTheCoordinatesOfTheFile) {
    Scene scene;
    scene.origin = {1e6, 0, -3e6};
    CameraRequest request;
    request.from = glm::dvec3(1e6 + 2, 3, -3e6 + 5);
    request.at = glm::dvec3(1e6, 3, -3e6 + 5);
    const Camera camera = makeCamera(scene, request, 4, 3, {});
    EXPECT_EQ(camera.position, glm::dvec3(2, 3, 5));
    EXPECT_EQ(camera.back, glm::dvec3(1, 0, 0));
}

TEST(StatedView, LooksFromWhereItIsToldAtTheMiddleOrAPoint) {
    CameraRequest request;
    request.from = glm::dvec3(2, 0, 5);
    const Camera camera = makeCamera(withTriangle(), request, 200, 100);
    EXPECT_EQ(camera.position, glm::dvec3(2, 0, 5));
    EXPECT_EQ(camera.back, glm::dvec3(0, 0, 1));
    EXPECT_EQ(camera.up, glm::dvec3(0, 1, 0));
    EXPECT_DOUBLE_EQ(camera.halfWidth, 2 * camera.halfHeight);
    request.at = glm::dvec3(7, 0, 5);
    EXPECT_EQ(makeCamera(withTriangle(), request, 200, 100).back, glm::dvec3(-1, 0, 0));
    request.at = request.from;
    EXPECT_THROW(makeCamera(withTriangle(), request, 200, 100), SceneError);
}

TEST(StatedView, AnAngleIsThatOfTheHeight) {
    CameraRequest request;
    request.from = glm::dvec3(2, 0, 5);
    request.fieldOfView = std::acos(0.0);
    const Camera camera = makeCamera(withTriangle(), request, 300, 100);
    EXPECT_DOUBLE_EQ(camera.halfHeight, 1);
    EXPECT_DOUBLE_EQ(camera.halfWidth, 3);
    FileCamera file;
    file.halfWidth = 0.2;
    CameraRequest ofFile(CameraChoice::File);
    ofFile.fieldOfView = std::acos(0.0);
    EXPECT_DOUBLE_EQ(makeCamera(sceneWith(file), ofFile, 300, 100).halfHeight, 1);
}

TEST(StatedView, ALensIsHalfItsDiameterAndOfNoUseToOrthographicCameras) {
    FileCamera file;
    CameraRequest request(CameraChoice::File);
    request.aperture = 0.01;
    request.focus = 3;
    const Camera camera = makeCamera(sceneWith(file), request, 20, 10);
    EXPECT_DOUBLE_EQ(camera.lensRadius, 0.005);
    EXPECT_DOUBLE_EQ(camera.focusDistance, 3);
    file.projection = Projection::Orthographic;
    file.halfWidth = 1;
    EXPECT_THROW(makeCamera(sceneWith(file), request, 20, 10), SceneError);
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

/// Where the middle of the picture lies is the file's, in pictures of any shape; another angle of
/// view scales all of the picture.
TEST(FileCamera, MiddlesBesideTheAxisStay) {
    Scene scene;
    scene.cameras.push_back({});
    scene.cameras[0].halfWidth = 2, scene.cameras[0].halfHeight = 1;
    scene.cameras[0].shift = {0.5, -0.25};
    EXPECT_EQ(makeCamera(scene, CameraChoice::File, 200, 100).shift, glm::dvec2(0.5, -0.25));
    EXPECT_EQ(makeCamera(scene, CameraChoice::File, 100, 100).shift, glm::dvec2(0.5, -0.25));
    EXPECT_EQ(makeCamera(scene, CameraChoice::Frame, 100, 100).shift, glm::dvec2(0));
    CameraRequest narrow = CameraChoice::File;
    narrow.fieldOfView = 2 * std::atan(0.5);
    const Camera camera = makeCamera(scene, narrow, 200, 100);
    EXPECT_NEAR(camera.shift.x, 0.25, 1e-12);
    EXPECT_NEAR(camera.shift.y, -0.125, 1e-12);
    EXPECT_NEAR(camera.halfWidth, 1, 1e-12);
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
    const PictureSize size = defaultPictureSize(sceneWith(file), CameraChoice::File);
    EXPECT_EQ(size.width, 800u);
    EXPECT_EQ(size.height, 400u);
    file.halfHeight.reset();
    EXPECT_EQ(defaultPictureSize(sceneWith(file), CameraChoice::File).height, 600u);
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
    const Camera camera = makeCamera(scene, CameraChoice::Frame, 800, 600);
    const double distance = 1.5 * std::sqrt(12.0);
    EXPECT_NEAR(camera.position.x, distance * 0.6, 1e-12);
    EXPECT_NEAR(camera.position.y, 0, 1e-12);
    EXPECT_NEAR(camera.position.z, distance * 0.8, 1e-12);
}

/// A file of no dialect whose camera states its whole shape.
Scene sceneWithACameraOfItsOwn() {
    FileCamera file;
    file.halfWidth = 0.5, file.halfHeight = 0.25;
    file.position = {0, 0, 5};
    Scene scene = sceneWith(file);
    scene.framing = Bounds{glm::vec3(-1), glm::vec3(1)};
    return scene;
}

TEST(FramingConventions, PicturesOfAnotherSizeAreCropsOrTheSameView) {
    const Scene scene = sceneWithACameraOfItsOwn();
    const FramingConventions crops{.pictureSize = PictureSize{800, 600}};
    const Camera whole = makeCamera(scene, CameraChoice::Frame, 800, 600, crops);
    for (const uint32_t n : {1u, 2u, 4u, 16u}) {
        const Camera part = makeCamera(scene, CameraChoice::Frame, 1600 / n, 600, crops);
        EXPECT_DOUBLE_EQ(part.halfWidth, whole.halfWidth * 2 / n); // 800 pixels or less: a part
        EXPECT_DOUBLE_EQ(part.halfHeight, whole.halfHeight);
        const Camera scaled = makeCamera(scene, CameraChoice::Frame, 800 * n, 600 * n);
        EXPECT_DOUBLE_EQ(scaled.halfWidth, whole.halfWidth);
        EXPECT_DOUBLE_EQ(scaled.halfHeight, whole.halfHeight);
    }
    EXPECT_EQ(defaultPictureSize(scene, CameraChoice::File, crops).height, 600u);
    EXPECT_EQ(defaultPictureSize(scene, CameraChoice::File).height, 400u);
}

TEST(FramingConventions, EverySceneCanBeFramed) {
    const Scene scene = sceneWithACameraOfItsOwn();
    const FramingConventions frames{.framesEveryScene = true};
    const auto distance = [&](CameraChoice choice, const FramingConventions& conventions) {
        return glm::length(makeCamera(scene, choice, 800, 600, conventions).position);
    };
    EXPECT_DOUBLE_EQ(distance(CameraChoice::Automatic, {}), 5);
    EXPECT_DOUBLE_EQ(distance(CameraChoice::Automatic, frames), 1.5 * std::sqrt(12.0));
    EXPECT_DOUBLE_EQ(distance(CameraChoice::File, frames), 5);
}

TEST(FramingConventions, DepthRangesHoldForFramedViewsOrNot) {
    Scene scene = sceneWithACameraOfItsOwn();
    scene.cameras[0].nearDistance = 1, scene.cameras[0].farDistance = 2;
    const auto farOf = [&](CameraChoice choice, const FramingConventions& conventions) {
        return makeCamera(scene, choice, 800, 600, conventions).farDistance;
    };
    EXPECT_EQ(farOf(CameraChoice::File, {}), 2);
    EXPECT_GE(farOf(CameraChoice::Frame, {}), 1e30) << "a framed view shows all of the scene";
    EXPECT_EQ(farOf(CameraChoice::Frame, {.clipsFramedViews = true}), 2);
}

TEST(FramingConventions, ScenesWithoutACameraAreSeenFromTheFrontOrAlongAnAxis) {
    Scene scene;
    scene.framing = Bounds{glm::vec3(-1), glm::vec3(1)};
    const auto from = [&](const FramingConventions& conventions) {
        return makeCamera(scene, CameraChoice::Automatic, 800, 600, conventions).back;
    };
    EXPECT_GT(from({}).z, 0.8);
    EXPECT_GT(std::min(from({}).x, from({}).y), 0.2) << "and shows three sides of a box";
    EXPECT_LT(glm::distance(from(cs184Framing()), glm::dvec3(0, 0, 1)), 1e-15);
}

/// The least and the greatest places in the picture, 0 to 1, of points that a camera sees.
std::pair<glm::dvec2, glm::dvec2> extentIn(const Camera& camera,
                                           const std::vector<glm::vec3>& points) {
    glm::dvec2 least(1e9), most(-1e9);
    for (const glm::vec3& p : points) {
        const glm::dvec3 to = glm::dvec3(p) - camera.position;
        const double ahead = -glm::dot(to, camera.back);
        EXPECT_GT(ahead, 0);
        const glm::dvec2 at(0.5 + glm::dot(to, camera.right) / ahead / camera.halfWidth / 2,
                            0.5 - glm::dot(to, camera.up) / ahead / camera.halfHeight / 2);
        least = glm::min(least, at), most = glm::max(most, at);
    }
    return {least, most};
}

/// A long thin triangle off the origin fills nine tenths of the picture in one direction, and is in
/// its middle in both; turned, every picture shows all of it from the same distance.
TEST(FramingConventions, ScenesWithoutACameraFillThePicture) {
    Scene scene;
    scene.positions = {{3, 7, 1}, {3.5f, 9, 1}, {3, 7, 4}, {500, 7, 2}};
    scene.triangles.resize(2);
    scene.triangles[0].corner[1] = 1, scene.triangles[0].corner[2] = 2;
    scene.framing = scene.bounds(); // what comes after is not framed
    scene.triangles[1].corner[1] = 2, scene.triangles[1].corner[2] = 3;
    const std::vector<glm::vec3> shown(scene.positions.begin(), scene.positions.begin() + 3);
    for (const auto& [width, height] : {std::pair(800u, 600u), {100u, 900u}}) {
        CameraRequest request;
        for (const bool hasAngle : {false, true}) {
            if (hasAngle) request.fieldOfView = 0.5;
            const auto [least, most] = extentIn(makeCamera(scene, request, width, height), shown);
            EXPECT_NEAR(std::max(most.x - least.x, most.y - least.y), 0.9, 1e-5);
            for (int axis = 0; axis < 2; ++axis)
                EXPECT_NEAR((least[axis] + most[axis]) / 2, 0.5, 0.1);
        }
    }
    CameraRequest turned;
    turned.isOneOfTurns = true;
    double greatest = 0;
    for (int i = 0; i < 8; ++i) {
        turned.turn = i * 0.785;
        const auto [least, most] = extentIn(makeCamera(scene, turned, 800, 600), shown);
        EXPECT_GT(std::min(least.x, least.y), 0.03);
        EXPECT_LT(std::max(most.x, most.y), 0.97);
        greatest = std::max({greatest, most.x - least.x, most.y - least.y});
    }
    EXPECT_GT(greatest, 0.5);
}

/// Three cameras at z = 5, 6 and 7; the second one's name is a number.
Scene sceneWithThreeCameras() {
    Scene scene;
    scene.file = "a.xyz";
    scene.framing = Bounds{glm::vec3(-1), glm::vec3(1)};
    for (const char* name : {"front", "1", "top view"}) {
        FileCamera camera;
        camera.name = name;
        camera.position.z = 5 + double(scene.cameras.size());
        camera.pointAhead = {0, double(scene.cameras.size()), 1};
        scene.cameras.push_back(camera);
    }
    return scene;
}

TEST(SeveralCameras, TheFirstIsTakenOrTheLast) {
    const Scene scene = sceneWithThreeCameras();
    const auto z = [&](const FramingConventions& conventions) {
        return makeCamera(scene, CameraChoice::File, 80, 60, conventions).position.z;
    };
    EXPECT_EQ(z({}), 5);
    EXPECT_EQ(z({.lastOfSeveral = true}), 7);
    // The direction of framed views is that of the same camera.
    EXPECT_NEAR(makeCamera(scene, CameraChoice::Frame, 80, 60).back.y, 0, 1e-15);
    EXPECT_GT(makeCamera(scene, CameraChoice::Frame, 80, 60, {.lastOfSeveral = true}).back.y, 0.5);
}

TEST(SeveralCameras, AreTakenByNameOrNumber) {
    const Scene scene = sceneWithThreeCameras();
    const auto z = [&](const char* name) {
        return makeCamera(scene, {CameraChoice::File, name}, 80, 60, {.lastOfSeveral = true})
            .position.z;
    };
    EXPECT_EQ(z("front"), 5);
    EXPECT_EQ(z("top view"), 7);
    EXPECT_EQ(z("2"), 6);
    EXPECT_EQ(z("1"), 6) << "names go before numbers";
    EXPECT_EQ(defaultPictureSize(scene, {CameraChoice::File, "3"}).width, 800u);
}

TEST(SeveralCameras, OtherNamesAreErrorsThatListThem) {
    const auto error = [](const Scene& scene, const char* name) -> std::string {
        try {
            makeCamera(scene, {CameraChoice::File, name}, 80, 60);
        } catch (const SceneError& e) {
            return e.what();
        }
        return "no error";
    };
    const Scene scene = sceneWithThreeCameras();
    EXPECT_EQ(error(scene, "back"),
              "a.xyz: has no camera 'back'; it has 1 'front', 2 '1', 3 'top view'");
    for (const char* name : {"0", "4", "3 ", "-1", "Front", "99999999999999999999"})
        EXPECT_NE(error(scene, name), "no error") << name;
    EXPECT_EQ(error(Scene{.file = "b.xyz"}, "1"), "b.xyz: has no camera '1'; it has none at all");
}

TEST(FramingConventions, DepthIsMeasuredAlongTheAxisOrTheRay) {
    const Scene scene = sceneWithACameraOfItsOwn();
    const auto alongRay = [&](const FramingConventions& conventions) {
        return makeCamera(scene, CameraChoice::File, 800, 600, conventions).clipAlongRay;
    };
    EXPECT_FALSE(alongRay({}));
    EXPECT_TRUE(alongRay({.clipsAlongRay = true}));
}

} // namespace
} // namespace stromboli::test
