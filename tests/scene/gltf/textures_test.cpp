// Textures, their coordinates, and tangents.

#include "scene/model/surface_lookup.hpp"
#include "tests/scene/gltf/material_text.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(GltfTextures, Samplers) {
    const Scene scene = sceneOf(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
        "metallicRoughnessTexture": {"index": 1}})");
    ASSERT_EQ(scene.textures.size(), 2u);
    const Texture& color = scene.textures[0];
    EXPECT_EQ(color.wrapU, Wrap::Clamp);
    EXPECT_EQ(color.wrapV, Wrap::Mirror);
    EXPECT_TRUE(color.nearest);
    EXPECT_TRUE(color.srgb);
    const Texture& rough = scene.textures[1];
    EXPECT_EQ(rough.wrapU, Wrap::Repeat);
    EXPECT_FALSE(rough.nearest);
    EXPECT_FALSE(rough.srgb);
    EXPECT_THAT(scene.images.at(color.image).words, ElementsAre(0xFF030201u, 0xFF060504u));
    EXPECT_EQ(scene.images.at(rough.image).format, TexelFormat::RgbaHalf);
}

TEST(GltfTextures, BytesAreSharedBetweenMeanings) {
    const Scene scene = sceneOf(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
        "metallicRoughnessTexture": {"index": 0}})");
    EXPECT_EQ(scene.textures.size(), 2u);
    EXPECT_EQ(scene.images.size(), 1u);
    // Those of 16 bits are decoded for one of them.
    EXPECT_EQ(sceneOf(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 1},
        "metallicRoughnessTexture": {"index": 1}})")
                  .images.size(),
              2u);
}

TEST(GltfTextures, AreShrunk) {
    SceneConventions conventions;
    conventions.selection.largestTexture = 1;
    const Scene scene =
        load(withMaterial(R"("pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}})"),
             conventions);
    EXPECT_EQ(scene.images.at(0).width, 1u);
    EXPECT_THAT(scene.images.at(0).words, ElementsAre(0xFF050403u)); // halves are rounded up
}

TEST(GltfTextures, Transforms) {
    // The marker of Khronos' TextureTransformTest: a picture turned by 22.5 degrees shows the point
    // (0.777, 0.778) at (0.421, 1.016).
    const Material turned = materialOf(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"rotation": 0.39269908169872414}}}})");
    const glm::vec3 uv(0.42095f, 1.01627f, 1);
    EXPECT_NEAR(glm::dot(turned.textures.at(0).uRow, uv), 0.7778, 1e-3);
    EXPECT_NEAR(glm::dot(turned.textures.at(0).vRow, uv), 0.7778, 1e-3);
    const Material moved = materialOf(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"offset": [1, 2], "scale": [3, 4], "texCoord": 3}}}})");
    EXPECT_EQ(moved.textures.at(0).uRow, glm::vec3(3, 0, 1));
    EXPECT_EQ(moved.textures.at(0).vRow, glm::vec3(0, 4, 2));
}

TEST(GltfTextures, AnyTwoSetsOfCoordinates) {
    const Scene scene =
        sceneOf(R"("normalTexture": {"index": 0, "texCoord": 3}, "pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}})");
    const Material& m = scene.materials.at(0);
    const TextureUse* normal = useOf(m, TextureSlot::Normal);
    const TextureUse* base = useOf(m, TextureSlot::BaseColor);
    ASSERT_TRUE(normal && base);
    const VertexAttributes& a = scene.attributes.at(scene.attributeCorners.at(0)[0]);
    EXPECT_EQ(a.uv[base->uvSet], glm::vec2(0, 1));
    EXPECT_EQ(a.uv[normal->uvSet], glm::vec2(5, 6));
}

TEST(GltfTextures, NormalMapsNeedTangents) {
    const Scene scene = sceneOf(R"("normalTexture": {"index": 0, "scale": 0.5})");
    EXPECT_EQ(useOf(scene.materials.at(0), TextureSlot::Normal)->scale, 0.5f);
    for (const uint32_t corner : scene.attributeCorners.at(0))
        EXPECT_EQ(scene.attributes.at(corner).tangent, glm::vec4(1, 0, 0, 1));
    // What nothing looks at is not kept.
    EXPECT_EQ(sceneOf(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})")
                  .attributes.at(0)
                  .tangent,
              glm::vec4(0));
    EXPECT_TRUE(sceneOf("").attributes.empty());
}

TEST(GltfTextures, StatedTangentsAreKept) {
    GltfText g = withMaterial(R"("normalTexture": {"index": 0})");
    const size_t tangents = g.addAccessor<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4");
    std::string& mesh = g.arrays["meshes"][0];
    mesh.insert(mesh.find("\"POSITION\""), fmt::format(R"("TANGENT": {}, )", tangents));
    EXPECT_EQ(load(g).attributes.at(0).tangent, glm::vec4(0, 1, 0, -1));
}

/// The tangent of the first corner where the normal map has this KHR_texture_transform.
glm::vec4 tangentUnder(const std::string& transform, bool isStated = false) {
    GltfText g = withMaterial(R"("normalTexture": {"index": 0, )" +
                              extension("KHR_texture_transform", transform) + "}");
    const size_t tangents = g.addAccessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    std::string& mesh = g.arrays["meshes"][0];
    if (isStated)
        mesh.insert(mesh.find("\"POSITION\""), fmt::format(R"("TANGENT": {}, )", tangents));
    const Scene scene = load(g);
    const uint32_t corner = scene.attributeCorners.at(0)[0];
    return scene.attributes.at(corner).tangent;
}

/// The picture's u is along x and its v along -y before it is turned.
TEST(GltfTextures, TangentsTurnAndMirrorWithThePicture) {
    const auto expectTangent = [](const std::string& transform, const glm::vec4& expected) {
        for (const bool isStated : {false, true})
            for (int i = 0; i < 4; ++i)
                EXPECT_NEAR(tangentUnder(transform, isStated)[i], expected[i], 1e-6) << transform;
    };
    expectTangent(R"("offset": [0.5, 0.1], "scale": [3, 3])", {1, 0, 0, 1});
    expectTangent(R"("rotation": 1.5707963267948966)", {0, -1, 0, 1});
    expectTangent(R"("rotation": 0.52359877559829887)", {std::sqrt(0.75f), -0.5f, 0, 1});
    expectTangent(R"("scale": [-1, 1])", {-1, 0, 0, -1});
    expectTangent(R"("scale": [1, -1])", {1, 0, 0, -1});
    expectTangent(R"("scale": [-2, -2])", {-1, 0, 0, 1});
    // First scaled, then turned: u' = v, v' = u.
    expectTangent(R"("scale": [-1, 1], "rotation": 1.5707963267948966)", {0, -1, 0, -1});
}

TEST(GltfTextures, OfExtensions) {
    GltfText g = withMaterial(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})");
    g.addTo("images", fmt::format(R"("uri": "data:image/webp;base64,{}")",
                                  toBase64(webp(1, 1, {9, 8, 7, 6}))));
    g.arrays["textures"][0] = R"({"source": 0, "extensions": {"EXT_texture_webp": {"source": 2}}})";
    EXPECT_THAT(load(g).images.at(0).words, ElementsAre(0x06070809u));
    // A picture that is always read comes first.
    g.arrays["textures"][0] = R"({"source": 0, "extensions": {"MSFT_texture_dds": {"source": 2}}})";
    EXPECT_NE(load(g).images.at(0).words.at(0), 0x06070809u);
    g.arrays["textures"][0] = R"({"extensions": {"MSFT_texture_dds": {"source": 2}}})";
    EXPECT_THAT(load(g).images.at(0).words, ElementsAre(0x06070809u));
    g.arrays["textures"][0] = R"({"extensions": {"KHR_texture_basisu": {"source": 2}}})";
    const Scene scene = load(g);
    EXPECT_TRUE(scene.images.empty());
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("KHR_texture_basisu")));
}

TEST(GltfTextures, MissingAndDamagedPictures) {
    GltfText g = withMaterial(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})");
    g.arrays["images"][0] = R"({"uri": "none.png"})";
    const auto said = [&] {
        const Scene scene = load(g);
        EXPECT_EQ(scene.triangles.size(), 1u);
        return scene.report.forgiven.size() == 1 ? scene.report.forgiven[0] : "";
    };
    EXPECT_THAT(said(), HasSubstr("<images[0]>: "));
    EXPECT_THAT(said(), HasSubstr("none.png: cannot be opened for reading: No such file"));
    g.arrays["images"][0] =
        fmt::format(R"({{"uri": "data:image/png;base64,{}"}})",
                    toBase64(png8(9, 9, 3, std::vector<uint8_t>(243)).substr(0, 44)));
    EXPECT_THAT(said(),
                HasSubstr("<images[0]>: data:image/png;base64,...: cannot be read as PNG: "));
    g.arrays["images"][0] = "{}";
    EXPECT_THAT(said(), HasSubstr("<images[0]>: has neither 'uri' nor 'bufferView'"));
}

} // namespace
} // namespace stromboli::test
