#include "host/bench/path_bench.hpp"

#include <gtest/gtest.h>

namespace stromboli::bench {
namespace {

/// A word of TexelFormat::Rgba8.
constexpr uint32_t rgba(uint32_t red, uint32_t green, uint32_t blue, uint32_t alpha) {
    return red | green << 8 | blue << 16 | alpha << 24;
}

/// A scene of one material, whose textures are pictures of nearest texels in one line.
Scene painted(Material material,
              const std::vector<std::pair<TextureSlot, std::vector<uint32_t>>>& pictures) {
    Scene scene;
    for (const auto& [slot, texels] : pictures) {
        const auto number = uint32_t(scene.images.size());
        scene.images.push_back({.width = uint32_t(texels.size()), .height = 1, .words = texels});
        scene.textures.push_back({.image = number, .nearest = true});
        material.textures.push_back({.slot = slot, .texture = number});
    }
    scene.materials.push_back(std::move(material));
    return scene;
}

Material principled() {
    Material m;
    m.kind = MaterialKind::Principled;
    return m;
}

TEST(TextureMeans, MultiplyTheFactorsOfTheMaterial) {
    Material m = principled();
    m.principled.baseColor = {1, 0.5f, 1};
    m.principled.roughness = 0.5f;
    m.principled.metallic = 1;
    const Scene means = withMeans(
        painted(m, {{TextureSlot::BaseColor, {rgba(255, 0, 51, 255), rgba(0, 255, 51, 255)}},
                    {TextureSlot::MetallicRoughness, {rgba(9, 102, 51, 9)}},
                    {TextureSlot::Normal, {rgba(0, 0, 255, 255)}}}));
    const Material& mean = means.materials[0];
    EXPECT_FLOAT_EQ(mean.principled.baseColor.r, 0.5f);
    EXPECT_FLOAT_EQ(mean.principled.baseColor.g, 0.25f);
    EXPECT_FLOAT_EQ(mean.principled.baseColor.b, 0.2f);
    EXPECT_FLOAT_EQ(mean.principled.roughness, 0.2f);
    EXPECT_FLOAT_EQ(mean.principled.metallic, 0.2f);
    EXPECT_TRUE(mean.textures.empty());
}

TEST(TextureMeans, LetThroughWhatIsCutOutOfAMask) {
    Material m = principled();
    m.alphaMode = AlphaMode::Mask;
    // Opacities 0.72, 0.48, 0.24 and 0: with a cutoff of 0.4 half of the surface is there.
    m.opacity = 0.9f;
    m.alphaCutoff = 0.4f;
    const Scene means = withMeans(painted(
        m, {{TextureSlot::BaseColor,
             {rgba(0, 0, 0, 204), rgba(0, 0, 0, 136), rgba(0, 0, 0, 68), rgba(0, 0, 0, 0)}}}));
    EXPECT_EQ(means.materials[0].alphaMode, AlphaMode::Blend);
    EXPECT_FLOAT_EQ(means.materials[0].opacity, 0.5f);
}

TEST(TextureMeans, BlendByTheMeanOfAllThatMultipliesOpacity) {
    Material m = principled();
    m.alphaMode = AlphaMode::Blend;
    m.opacity = 0.5f;
    Scene scene = painted(m, {{TextureSlot::BaseColor, {rgba(0, 0, 0, 255), rgba(0, 0, 0, 51)}},
                              {TextureSlot::Opacity, {rgba(255, 0, 0, 0), rgba(51, 0, 0, 0)}}});
    // Alike, the textures' opacities multiply each other: 0.5 (1 + 0.04) / 2.
    EXPECT_FLOAT_EQ(withMeans(scene).materials[0].opacity, 0.26f);
    // Turned round: 0.5 (0 + 0.2 * 0.8) / 2.
    scene.materials[0].textures[1].scale = -1;
    EXPECT_FLOAT_EQ(withMeans(scene).materials[0].opacity, 0.04f);
}

TEST(TextureMeans, BlendByATextureOfOpacityAlone) {
    Material m = principled();
    m.alphaMode = AlphaMode::Mask;
    const Scene scene =
        painted(m, {{TextureSlot::Opacity, {rgba(255, 0, 0, 0), rgba(0, 0, 0, 0)}}});
    EXPECT_FLOAT_EQ(withMeans(scene).materials[0].opacity, 0.5f);
}

TEST(TextureMeans, LeaveOpaqueWhatHasNoOpacityByATexture) {
    Material opaque = principled();
    const auto halfClear = std::vector<uint32_t>{rgba(0, 0, 0, 0), rgba(0, 0, 0, 255)};
    EXPECT_EQ(
        withMeans(painted(opaque, {{TextureSlot::BaseColor, halfClear}})).materials[0].alphaMode,
        AlphaMode::Opaque);
    Material mask = principled();
    mask.alphaMode = AlphaMode::Mask;
    const Scene scene = withMeans(painted(mask, {{TextureSlot::Normal, halfClear}}));
    EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Mask);
    EXPECT_EQ(scene.materials[0].opacity, 1);
}

} // namespace
} // namespace stromboli::bench
