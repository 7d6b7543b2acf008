// Each convention, alone: the builder asks for it by its name and not for the renderer it is of.

#include "host/cs184/cs184.hpp"
#include "scene/build/conventions.hpp"
#include "scene/build/scene_builder.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli::build {
namespace {

using testing::Contains;
using testing::HasSubstr;

Scene withLight(LightKind kind, const glm::dmat4& toWorld, const SceneConventions& conventions) {
    SceneBuilder builder("scene.xyz", conventions);
    Light light;
    light.kind = kind;
    builder.placeLight(light, toWorld);
    return builder.finish();
}

TEST(Conventions, AreasBecomeGeometryOrStayLights) {
    SceneConventions conventions;
    const Scene emitter = withLight(LightKind::Area, glm::dmat4(1), conventions);
    EXPECT_EQ(emitter.triangles.size(), 2u);
    EXPECT_TRUE(emitter.lights.empty());
    conventions.areaLights = AreaLights::StayLights;
    const Scene light = withLight(LightKind::Area, glm::dmat4(1), conventions);
    EXPECT_TRUE(light.triangles.empty());
    EXPECT_EQ(light.lights.size(), 1u);
}

TEST(Conventions, DirectionalLightsAimAlongAnAxisOrAtAPoint) {
    const glm::dmat4 there = glm::translate(glm::dmat4(1), glm::dvec3(0, 5, 1));
    SceneConventions conventions;
    const Scene axis = withLight(LightKind::Directional, there, conventions);
    EXPECT_EQ(axis.lights.at(0).direction, glm::vec3(0, 0, -1));
    conventions.directionalAim = DirectionalAim::NodePoint;
    const Scene point = withLight(LightKind::Directional, there, conventions);
    EXPECT_EQ(point.lights.at(0).direction, glm::vec3(0, -1, 0));
}

TEST(Conventions, AmbientLightComesFromEverywhereOrFromAbove) {
    SceneConventions conventions;
    EXPECT_FALSE(
        withLight(LightKind::Ambient, glm::dmat4(1), conventions).lights.at(0).upperHemisphereOnly);
    conventions.ambientFrom = AmbientFrom::UpperHemisphere;
    EXPECT_TRUE(
        withLight(LightKind::Ambient, glm::dmat4(1), conventions).lights.at(0).upperHemisphereOnly);
}

TEST(Conventions, SpotLightsCanBeLeftOut) {
    SceneConventions conventions;
    EXPECT_EQ(withLight(LightKind::Spot, glm::dmat4(1), conventions).lights.size(), 1u);
    conventions.spotLights = false;
    conventions.renderer = "another renderer";
    const Scene scene = withLight(LightKind::Spot, glm::dmat4(1), conventions);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("gives no light in another renderer")));
}

TEST(Conventions, CamerasCanKeepTheirOwnLengths) {
    for (const bool scales : {true, false}) {
        SceneConventions conventions;
        conventions.scaleCameras = scales;
        SceneBuilder builder("scene.xyz", conventions);
        FileCamera camera;
        camera.farDistance = 10;
        builder.placeCamera(camera, glm::scale(glm::dmat4(1), glm::dvec3(2)));
        EXPECT_EQ(builder.finish().cameras.at(0).farDistance, scales ? 20 : 10);
    }
}

TEST(Conventions, NormalsCanBeRecomputed) {
    SceneConventions conventions;
    conventions.vertexNormals = VertexNormals::Recomputed;
    conventions.winding = Winding::AsTransformed;
    SceneBuilder builder("scene.xyz", conventions);
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    mesh.normals = {{1, 1, 1}}; // the file's, which do not count
    const auto corner = [](uint32_t i) { return Corner{i, 0}; };
    MeshPart& part = mesh.parts.emplace_back();
    for (const auto& [a, b, c] :
         {std::array<uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
        part.push_back({corner(a), corner(b), corner(c)});
    const uint32_t materials[] = {builder.defaultMaterial()};
    builder.place({}, builder.addMesh("tetrahedron", mesh), glm::dmat4(1), materials, "instance");
    const Scene scene = builder.finish();
    EXPECT_EQ(scene.normals.size(), 4u);
    // The sum of the cross products (0, 0, -2), (0, -3, 0) and (-6, 0, 0) around corner 0.
    const glm::dvec3 normal = scene.normals.at(scene.triangles[0].normals[0]);
    EXPECT_LT(glm::distance(normal, glm::normalize(glm::dvec3(-6, -3, -2))), 1e-7);
}

TEST(Conventions, TheDefaultFollowsNoOtherRenderer) {
    EXPECT_TRUE(SceneConventions{}.areDefault());
    EXPECT_FALSE(cs184Conventions().areDefault());
}

} // namespace
} // namespace stromboli::build
