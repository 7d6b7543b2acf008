// What a scene without any light gets, and which scenes those are.

#include "host/cs184/cs184.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/model/default_light.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli::build {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

struct Content {
    glm::vec3 emission{0};
    std::vector<glm::vec3> lights; ///< colours
    bool sphere = true;
};

Scene made(const Content& content, const SceneConventions& conventions = {}) {
    SceneBuilder builder("scene.xyz", conventions);
    Material material;
    material.emission = content.emission;
    const std::vector<uint32_t> materials{builder.addMaterial(material)};
    if (content.sphere)
        builder.place({"scene.xyz", 1, "ball"}, builder.addSphere("ball", 1), glm::dmat4(1),
                      materials, "ball");
    for (const glm::vec3& color : content.lights) {
        Light light;
        light.color = color;
        builder.placeLight(light, glm::dmat4(1));
    }
    return builder.finish();
}

TEST(DefaultLight, IsASkyForScenesWhereNothingShines) {
    const Scene dark = made({});
    ASSERT_EQ(dark.lights.size(), 1u);
    EXPECT_EQ(dark.lights[0].kind, LightKind::Ambient);
    EXPECT_EQ(dark.lights[0].color, glm::vec3(1));
    EXPECT_TRUE(dark.lights[0].upperHemisphereOnly);
    EXPECT_THAT(dark.report.assumed, Contains(HasSubstr("no light")));
    const Scene black = made({.lights = {glm::vec3(0)}});
    ASSERT_EQ(black.lights.size(), 2u) << "a light that is black gives none";
    EXPECT_EQ(black.lights[1].color, glm::vec3(1));
}

/// A square of which a picture emits, a texel in four white.
Scene withPictureOfEmission(float emission, bool isLamp = false) {
    SceneBuilder builder("scene.xyz", {});
    TextureImage image;
    image.width = image.height = 2;
    image.words = {0xFFFFFFFFu, 0xFF000000u, 0xFF000000u, 0xFF000000u};
    Texture texture;
    texture.image = builder.addImage(image);
    Material material;
    material.emission = glm::vec3(emission);
    TextureUse use;
    use.slot = TextureSlot::Emission;
    use.texture = builder.addTexture(texture);
    material.textures.push_back(use);
    const std::vector<uint32_t> materials{builder.addMaterial(material)};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (const glm::dvec3& p : mesh.positions) {
        mesh.attributes.emplace_back();
        mesh.attributes.back().uv[0] = glm::vec2(p.x, p.y);
    }
    const auto corner = [](uint32_t i) { return Corner{i, kNoNormals, i}; };
    mesh.parts = {{{corner(0), corner(1), corner(2)}, {corner(0), corner(2), corner(3)}}};
    builder.place({"scene.xyz", 1, "square"}, builder.addMesh("square", mesh), glm::dmat4(1),
                  materials, "square");
    if (isLamp) builder.picturesOfEmissionAreLamps();
    return builder.finish();
}

TEST(DefaultLight, IsForScenesWhosePicturesOfEmissionLightNothing) {
    const Scene weak = withPictureOfEmission(0.01f); // a mean of 0.01 / 4 on all surfaces
    EXPECT_EQ(weak.lights.size(), 1u);
    EXPECT_THAT(weak.report.assumed, Contains(HasSubstr("too weak to light the surfaces")));
    EXPECT_TRUE(withPictureOfEmission(10).lights.empty());
    EXPECT_TRUE(withPictureOfEmission(0.01f, true).lights.empty());
    EXPECT_EQ(withPictureOfEmission(0, true).lights.size(), 1u);
}

TEST(DefaultLight, IsNotForScenesThatHaveLight) {
    for (const Content& content : {Content{.emission = {0, 0, 1e-6f}},
                                   Content{.lights = {{0, 1, 0}}}, Content{.sphere = false}}) {
        const Scene scene = made(content);
        EXPECT_EQ(scene.lights.size(), content.lights.size());
        EXPECT_THAT(scene.report.assumed, IsEmpty());
    }
}

TEST(DefaultLight, IsNotWhereTheConventionsHaveNone) {
    SceneConventions conventions;
    conventions.defaultLight = false;
    const Scene scene = made({}, conventions);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_FALSE(shines(scene));
    EXPECT_THAT(scene.report.assumed, IsEmpty());
    EXPECT_TRUE(made({}, cs184Conventions()).lights.empty());
}

/// An area light that becomes geometry is light all the same.
TEST(DefaultLight, IsNotForScenesWithAnAreaLight) {
    SceneBuilder builder("scene.xyz", {});
    const std::vector<uint32_t> materials{builder.defaultMaterial()};
    builder.place({"scene.xyz", 1, "ball"}, builder.addSphere("ball", 1), glm::dmat4(1), materials,
                  "ball");
    Light light;
    light.kind = LightKind::Area;
    builder.placeLight(light, glm::dmat4(1));
    const Scene scene = builder.finish();
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_TRUE(shines(scene));
}

} // namespace
} // namespace stromboli::build
