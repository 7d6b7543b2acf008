#include "scene/build/camera_pose.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace stromboli::build {
namespace {

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected) {
    EXPECT_LT(glm::distance(actual, expected), 1e-14)
        << actual.x << ' ' << actual.y << ' ' << actual.z;
}

TEST(CameraPose, IsOrthonormalAndRightHandedWhateverTheMatrix) {
    glm::dmat4 matrix(1);
    matrix[0] = {-3, 0.5, 0, 0};
    matrix[1] = {0.7, 2, 0.1, 0};
    matrix[2] = {0, 0.4, 5, 0};
    matrix[3] = {1, 2, 3, 1};
    FileCamera camera;
    ASSERT_TRUE(poseCamera(camera, matrix));
    expectNear(camera.position, {1, 2, 3});
    expectNear(camera.back, glm::normalize(glm::dvec3(0, 0.4, 5)));
    expectNear(camera.pointAhead, {1, 1.6, -2});
    for (const glm::dvec3& axis : {camera.right, camera.up, camera.back})
        EXPECT_NEAR(glm::length(axis), 1, 1e-14);
    expectNear(glm::cross(camera.right, camera.up), camera.back);
    EXPECT_GT(glm::dot(camera.up, glm::dvec3(matrix[1])), 0);
}

TEST(CameraPose, SingularMatricesHaveNone) {
    FileCamera camera;
    EXPECT_FALSE(poseCamera(camera, glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1))));
    EXPECT_FALSE(poseCamera(camera, glm::dmat4(0)));
    glm::dmat4 oneLine(1); // y and z are one line: the camera has no upright
    oneLine[1] = oneLine[2];
    EXPECT_FALSE(poseCamera(camera, oneLine));
    glm::dmat4 infinite(1);
    infinite[0][0] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(poseCamera(camera, infinite));
}

TEST(CameraPose, ScaleAppliesToLengthsAndNotToAngles) {
    FileCamera perspective;
    perspective.halfWidth = 0.5;
    perspective.nearDistance = 1, perspective.farDistance = 10;
    FileCamera orthographic = perspective;
    orthographic.projection = Projection::Orthographic;
    orthographic.halfHeight = 0.25;
    for (FileCamera* camera : {&perspective, &orthographic}) {
        scaleCamera(*camera, {2, 3, 4});
        EXPECT_EQ(camera->nearDistance, 4);
        EXPECT_EQ(camera->farDistance, 40);
    }
    EXPECT_EQ(perspective.halfWidth, 0.5);
    EXPECT_EQ(orthographic.halfWidth, 1);
    EXPECT_EQ(orthographic.halfHeight, 0.75);
}

} // namespace
} // namespace stromboli::build
