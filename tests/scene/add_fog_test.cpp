// Fog that a user puts into a scene.
#include "scene/add_fog.hpp"
#include "scene/camera/camera.hpp"
#include "scene/generate/scene_maker.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace scenes;

Scene roomWithGlass() {
    SceneMaker maker;
    maker.box({-1, -1, -1}, {1, 1, 1}, maker.add(diffuse(0.5f)), true);
    maker.sphere({0, 0, 0}, 0.25f, maker.add(glass(1.5f)));
    return maker.scene;
}

FogRequest request() {
    FogRequest fog;
    fog.density = 0.5;
    fog.color = {1, 0.5f, 0};
    fog.asymmetry = 0.25;
    return fog;
}

TEST(AddFog, SurroundsWhatIsThere) {
    Scene scene = roomWithGlass();
    addFog(scene, request());
    ASSERT_EQ(scene.media.size(), 1u);
    const Medium& fog = scene.media[0];
    EXPECT_EQ(fog.scattering, glm::vec3(0.5f, 0.25f, 0));
    EXPECT_EQ(fog.absorption, glm::vec3(0, 0.25f, 0.5f));
    EXPECT_EQ(fog.asymmetry, 0.25f);
    const Material& glass = scene.materials.at(scene.spheres.at(0).material);
    EXPECT_TRUE(glass.boundsMedia);
    EXPECT_EQ(glass.outside, 0u);
    EXPECT_EQ(glass.inside, kNoMedium);
    EXPECT_FALSE(scene.materials.at(0).boundsMedia); // walls let nothing through
}

/// A ball, at whose edge light passes into the fog; cameras are in it or not.
TEST(AddFog, HasAnEdge) {
    Scene scene = roomWithGlass();
    scene.environment = Environment{};
    addFog(scene, request());
    const Sphere& edge = scene.spheres.at(1);
    const Material& m = scene.materials.at(edge.material);
    EXPECT_TRUE(m.isNull());
    // The glass inside is a medium too, that counts before the fog.
    EXPECT_EQ(scene.media.at(m.inside).scattering, glm::vec3(0.5f, 0.25f, 0));
    EXPECT_EQ(m.outside, kNoMedium);
    EXPECT_GT(edge.radius, std::sqrt(3.0f));
    CameraRequest camera;
    camera.from = glm::dvec3(0.5, 0.5, 0.5);
    EXPECT_EQ(makeCamera(scene, camera, 4, 4, {}).medium, m.inside);
    camera.from = glm::dvec3(0, 0, 100);
    EXPECT_EQ(makeCamera(scene, camera, 4, 4, {}).medium, kNoMedium);
    // Views that frame the scene do not frame its fog.
    EXPECT_EQ(scene.framing->hi, glm::vec3(1));
}

/// Nothing comes from there, and rays need not pass an edge.
TEST(AddFog, HasNoEdgeInScenesWithoutASky) {
    Scene scene = roomWithGlass();
    addFog(scene, request());
    EXPECT_EQ(scene.spheres.size(), 1u);
    CameraRequest camera;
    camera.from = glm::dvec3(0, 0, 100);
    EXPECT_EQ(makeCamera(scene, camera, 4, 4, {}).medium, 0u);
}

/// What a file says of its camera holds for where the file puts it; all other views are in what
/// their place is in.
TEST(AddFog, ViewsAreInTheMediumOfTheirPlace) {
    Scene scene = roomWithGlass();
    scene.media.push_back(Medium{});
    Material& glass = scene.materials.at(scene.spheres.at(0).material);
    glass.boundsMedia = true;
    glass.inside = 0;
    FileCamera inFile;
    inFile.position = {0, 0, 0.9};
    inFile.medium = 0;
    scene.cameras.push_back(inFile);
    CameraRequest camera;
    EXPECT_EQ(makeCamera(scene, camera, 4, 4, {}).medium, 0u);
    camera.from = glm::dvec3(0, 0, 0.9);
    EXPECT_EQ(makeCamera(scene, camera, 4, 4, {}).medium, kNoMedium);
    camera.from = glm::dvec3(0, 0.1, 0);
    EXPECT_EQ(makeCamera(scene, camera, 4, 4, {}).medium, 0u);
}

/// Borders of the file that say nothing of their outside are in the fog.
TEST(AddFog, IsAroundOtherMedia) {
    Scene scene = roomWithGlass();
    scene.media.push_back(Medium{});
    Material& glass = scene.materials.at(scene.spheres.at(0).material);
    glass.boundsMedia = true;
    glass.inside = 0;
    addFog(scene, request());
    EXPECT_EQ(scene.materials.at(scene.spheres.at(0).material).inside, 0u);
    EXPECT_EQ(scene.materials.at(scene.spheres.at(0).material).outside, 1u);
}

} // namespace
} // namespace stromboli
