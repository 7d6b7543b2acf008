// Texels as the kernel reads them: each beside the one below it, with what is seen beyond the
// picture's edges.
#include "host/kernel/texel_packer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stromboli::test {
namespace {

/// A number that tells texels of a picture of up to 256 x 256 apart.
uint32_t texelAt(uint32_t x, uint32_t y) {
    return x | y << 8 | (x ^ y) << 16 | (255 - y) << 24;
}

/// A material whose colour is such a picture, by itself.
Scene scenePainted(uint32_t width, uint32_t height, Wrap wrap) {
    Scene scene;
    TextureImage image{.width = width, .height = height};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            image.words.push_back(texelAt(x, y));
    scene.images = {image};
    scene.textures = {{.wrapU = wrap, .wrapV = wrap}};
    scene.materials.resize(1);
    scene.materials[0].textures = {{.slot = TextureSlot::BaseColor, .texture = 0}};
    return scene;
}

/// Bytes as fractions of 65,535.
std::array<uint32_t, 2> fractionsOf(uint32_t texel) {
    const auto fraction = [&](uint32_t channel) { return 257 * (texel >> 8 * channel & 0xFF); };
    return {fraction(0) | fraction(1) << 16, fraction(2) | fraction(3) << 16};
}

/// Pictures higher and lower than what one thread packs at a time.
TEST(TexelRows, HoldEachTexelBesideTheOneBelow) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp})
        for (const uint32_t height : {1u, 7u, 15u, 16u, 17u, 100u}) {
            SCOPED_TRACE(height);
            const uint32_t width = 5;
            const Scene scene = scenePainted(width, height, wrap);
            const DetailPlan plan = planDetails(scene, {true});
            RowPages rows;
            TexelPacker packer(scene, plan, rows);
            ASSERT_EQ(packer.firstRowOf(scene.textures[0]), 0u);
            packer.pack();
            ASSERT_EQ(rows.size(), size_t(width + 2) * (height + 1));
            const auto edged = [&](int i, uint32_t n) {
                const int last = int(n) - 1;
                if (wrap == Wrap::Repeat) return uint32_t(i < 0 ? last : (i > last ? 0 : i));
                return uint32_t(i < 0 ? 0 : (i > last ? last : i));
            };
            for (int y = -1; y < int(height); ++y)
                for (int x = -1; x <= int(width); ++x) {
                    const uint32_t column = edged(x, width);
                    const auto upper = fractionsOf(texelAt(column, edged(y, height))),
                               lower = fractionsOf(texelAt(column, edged(y + 1, height)));
                    const Row expected = {upper[0], upper[1], lower[0], lower[1]};
                    ASSERT_EQ(rows[size_t(y + 1) * (width + 2) + size_t(x + 1)], expected)
                        << x << ", " << y;
                }
        }
}

} // namespace
} // namespace stromboli::test
