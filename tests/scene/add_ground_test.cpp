// A floor that a user asks for.
#include "scene/add_fog.hpp"
#include "scene/add_ground.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

TEST(AddGround, IsUnderAllThereIsAndFacesUp) {
    Scene scene;
    scene.spheres.push_back({{3, 5, -2}, 2, 0, 0});
    scene.materials.resize(1);
    scene.instances.emplace_back("ball");
    scene.attributeCorners = {}; // no triangle has any
    GroundRequest request;
    request.isGiven = true;
    request.color = {0.25f, 0.5f, 2};
    addGround(scene, request);
    ASSERT_EQ(scene.triangles.size(), 2u);
    for (const Triangle& t : scene.triangles) {
        EXPECT_EQ(scene.geometricNormal(t), glm::vec3(0, 1, 0));
        EXPECT_EQ(scene.materials[t.material].albedo, glm::vec3(0.25f, 0.5f, 1));
        EXPECT_EQ(scene.instances[t.instance], "ground");
    }
    const Bounds bounds = scene.bounds();
    EXPECT_LT(bounds.lo.y, 3);
    EXPECT_NEAR(bounds.lo.y, 3, 0.01) << "a hair below";
    EXPECT_GT(bounds.hi.x, 1000);
    EXPECT_LT(bounds.lo.z, -1000);
    ASSERT_TRUE(scene.framing) << "cameras frame what was there before";
    EXPECT_EQ(scene.framing->hi, glm::vec3(5, 7, 0));
}

/// A floor reaches much farther than the fog, whose ball light comes through.
TEST(AddGround, DoesNotMakeFogLarger) {
    const auto radius = [](bool hasGround) {
        Scene scene;
        scene.materials.resize(1);
        scene.instances.emplace_back("ball");
        scene.spheres.push_back({{0, 0, 0}, 2, 0, 0});
        scene.environment.emplace();
        if (hasGround) addGround(scene, {true, glm::vec3(0.5f), {}});
        FogRequest fog;
        fog.density = 0.1;
        addFog(scene, fog);
        return scene.spheres.back().radius;
    };
    EXPECT_EQ(radius(true), radius(false));
}

/// All frames of an animation have the same floor.
TEST(AddGround, LiesUnderWhatItIsToldTo) {
    Scene scene;
    scene.spheres.push_back({{0, 50, 0}, 2, 0, 0});
    scene.materials.resize(1);
    scene.instances.emplace_back("ball");
    addGround(scene, {true, glm::vec3(0.5f), Bounds{glm::vec3(-1), glm::vec3(1)}});
    EXPECT_NEAR(scene.bounds().lo.y, -1, 0.01);
    EXPECT_EQ(scene.framing->hi.y, 52);
}

TEST(AddGround, OfAnEmptySceneIsAtTheOrigin) {
    Scene scene;
    addGround(scene, {true, glm::vec3(0.5f), {}});
    EXPECT_NEAR(scene.bounds().lo.y, 0, 0.01);
}

} // namespace
} // namespace stromboli::test
