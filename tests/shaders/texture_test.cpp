// Textures as the kernel looks them up, and as the reference does, against the definition: the
// picture goes on for ever, as its wrap modes say, and bilinear filtering is a sum over all texels
// by tents of one texel's width.
#include "tests/shaders/texture_lookup.hpp"

#include "host/core/random.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/texture_types.h"
#include "tests/analytic/textured.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

/// Within the picture and up to some copies beyond. Away from the borders of nearest texels, where
/// rounding may fall on either side.
TEST_P(TextureLookup, IsTheDefinition) {
    Random random(11);
    std::vector<TextureQuery> queries;
    std::vector<size_t> primitives;
    for (size_t i = 0; i < rowOf_.size(); ++i)
        for (int k = 0; k < 64; ++k) {
            // Multiples of 1/256 that are no border: texel coordinates are multiples of 1/2048.
            const auto coordinate = [&] {
                return (std::floor(random.uniform() * 2048) - 1024 + 1.0 / 3) / 256;
            };
            queries.push_back({rowOf_[i], float(coordinate()), float(coordinate()), 0});
            primitives.push_back(i);
        }
    const std::vector<TextureAnswer> found = ask(queries);
    for (size_t q = 0; q < queries.size(); ++q) {
        const TextureUse& use = textureOf_[primitives[q]];
        PointAttributes at;
        at.uv[0] = {queries[q].u, queries[q].v};
        const glm::dvec4 kernel(found[q].color, found[q].alpha),
            reference = lookUp(scene_, use, at), right = expected(use, queries[q].u, queries[q].v);
        const bool isSrgb = scene_.textures[use.texture].srgb;
        for (int c = 0; c < 4; ++c) {
            // Coordinates up to 8 are rounded at 2^-21, times five texels; sRGB has its own error.
            ASSERT_NEAR(kernel[c], right[c], 1e-5 + (isSrgb ? 1.2e-4 * right[c] : 0.0))
                << "texture " << use.texture << " at " << queries[q].u << ", " << queries[q].v;
            ASSERT_NEAR(reference[c], right[c], 1e-12);
        }
    }
}

/// Slopes are the differences of what is looked up nearby, which is bilinear between the middles of
/// texels.
TEST_P(TextureLookup, SlopesAreDerivatives) {
    Random random(13);
    std::vector<TextureQuery> queries;
    std::vector<size_t> primitives;
    for (size_t i = 0; i < rowOf_.size(); ++i)
        for (int k = 0; k < 64; ++k) {
            queries.push_back({rowOf_[i], 4 * random.uniform() - 2, 4 * random.uniform() - 2,
                               gpu::SLOPE_OF_TEXTURE});
            primitives.push_back(i);
        }
    const std::vector<TextureAnswer> found = ask(queries);
    int compared = 0;
    for (size_t q = 0; q < queries.size(); ++q) {
        const TextureUse& use = textureOf_[primitives[q]];
        const glm::dvec2 uv(queries[q].u, queries[q].v);
        PointAttributes at;
        at.uv[0] = uv;
        const glm::dvec2 reference = slopeOf(scene_, use, at);
        glm::dvec2 right(0.0);
        bool isSmooth = true; // no middle of a texel is near
        for (int axis = 0; axis < 2; ++axis) {
            constexpr double kStep = 1e-5;
            glm::dvec2 step(0.0);
            step[axis] = kStep;
            const auto red = [&](double steps) {
                const glm::dvec2 there = uv + steps * step;
                return expected(use, there.x, there.y).x;
            };
            right[axis] = (red(1) - red(-1)) / (2 * kStep);
            isSmooth &= std::abs(red(1) + red(-1) - 2 * red(0)) < 1e-12;
        }
        if (!isSmooth) continue;
        ++compared;
        const bool isSrgb = scene_.textures[use.texture].srgb;
        for (int axis = 0; axis < 2; ++axis) {
            ASSERT_NEAR(reference[axis], right[axis], 1e-7);
            // Sums of differences of 1 at most, times five texels; sRGB has its own error.
            ASSERT_NEAR(found[q].color[axis], right[axis], 1e-4 + (isSrgb ? 2e-3 : 0.0))
                << "texture " << use.texture << " at " << uv.x << ", " << uv.y;
        }
    }
    EXPECT_GT(compared, int(queries.size()) / 2);
}

/// Coordinates without a place read some texel, not beyond the picture.
TEST_P(TextureLookup, AnyCoordinateIsHarmless) {
    const float odd[] = {NAN,   INFINITY,    -INFINITY, 3e38f, -3e38f,
                         1e10f, 16777216.0f, -1e-30f,   0,     1};
    std::vector<TextureQuery> queries;
    for (size_t i = 0; i < rowOf_.size(); ++i)
        for (const float u : odd)
            for (const float v : odd)
                queries.push_back({rowOf_[i], u, v, 0});
    for (const TextureAnswer& a : ask(queries))
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(a.color[c], 0);
            EXPECT_LE(a.color[c], 1);
            EXPECT_GT(a.alpha, 0) << "no texel is transparent: what is read beyond the picture is";
        }
}

/// Each of the 256 values of a byte; black and white exactly. What is not stored plainly is decoded
/// when it is packed.
TEST_P(TextureLookup, SrgbIsDecoded) {
    std::vector<glm::vec4> all;
    for (int i = 0; i < 256; ++i)
        all.emplace_back(glm::vec3(float(i) / 255), 1);
    Scene scene;
    TextureMaker t(scene);
    Material m;
    m.textures = {
        {.texture = t.texture({.image = t.bytes(256, 1, all), .nearest = true, .srgb = true})}};
    scene.materials = {m};
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles.push_back({{0, 1, 2}});
    t.attributes(1, [](const glm::vec3&) { return VertexAttributes{}; });
    scene_ = scene;
    pack();
    std::vector<TextureQuery> queries;
    for (int i = 0; i < 256; ++i)
        queries.push_back({gpu::MATERIAL_DETAIL_ROW + 1, (float(i) + 0.5f) / 256, 0.5f, 0});
    const std::vector<TextureAnswer> found = ask(queries);
    for (int i = 0; i < 256; ++i) {
        const double c = i / 255.0;
        const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        // Errors of the fit or of fractions of 65,535, and of two roundings of numbers up to 1.
        const double error =
            packed_.texelKinds & gpu::TEXEL_KIND_SRGB ? 1.1e-4 * linear : 0.5 / 65535;
        EXPECT_NEAR(found[size_t(i)].color.x, linear, error + 0x1p-23) << i;
    }
    EXPECT_EQ(found.front().color.x, 0);
    EXPECT_EQ(found.back().color.x, 1);
}

/// Leaves that are cut out: the alpha of the colours' texels is the red of another picture, or what
/// is left of it to 1. Where texels are plain there are two textures.
TEST_P(TextureLookup, HoldsTheOpacityOfAnother) {
    Random random(17);
    SceneMaker b;
    TextureMaker t(b.scene);
    std::vector<glm::vec4> colors, others;
    for (uint32_t i = 0; i < kTextureWidth * kTextureHeight; ++i) {
        colors.emplace_back(random.uniform(), random.uniform(), random.uniform(), 1);
        others.emplace_back(0.02f + 0.98f * random.uniform(), 1, 1, random.uniform());
    }
    const uint32_t color = t.bytes(kTextureWidth, kTextureHeight, colors),
                   bytes = t.bytes(kTextureWidth, kTextureHeight, others),
                   halves = t.halves(kTextureWidth, kTextureHeight, others);
    for (const uint32_t other : {bytes, halves})
        for (const bool srgb : {false, true})
            for (const float scale : {1.0f, -1.0f}) {
                Texture texture{.image = color, .wrapU = Wrap::Mirror, .srgb = true};
                Material m;
                m.alphaMode = AlphaMode::Blend;
                m.textures.push_back({.texture = t.texture(texture)});
                texture.image = other, texture.srgb = srgb;
                m.textures.push_back(
                    {.slot = TextureSlot::Opacity, .texture = t.texture(texture), .scale = scale});
                b.triangle({0, 0, scale}, {1, 0, float(srgb)}, {0, 1, float(other)}, b.add(m));
                t.attributes(1, [](const glm::vec3&) { return VertexAttributes{}; });
            }
    scene_ = b.scene;
    pack();
    const bool isHeld = GetParam().gathered != Gathered::None;
    EXPECT_EQ(packed_.looseSlots,
              1u << gpu::TEXTURE_BASE_COLOR | (isHeld ? 0u : 1u << gpu::TEXTURE_OPACITY));
    EXPECT_EQ(packed_.mostTextures, isHeld ? 1u : 2u);
    std::vector<TextureQuery> queries;
    std::vector<size_t> materials;
    for (size_t i = 0; i < packed_.primitives.size(); ++i)
        for (int k = 0; k < 16; ++k) {
            const uint32_t row = materialOf(packed_.primitives[i]) + gpu::MATERIAL_DETAIL_ROW + 1;
            const float u = 4 * random.uniform() - 2, v = 4 * random.uniform() - 2;
            queries.push_back({row, u, v, 0});
            if (!isHeld) queries.push_back({row + gpu::TEXTURE_USE_ROWS, u, v, 0});
            materials.push_back(scene_.triangles[packed_.bvh.primitiveOrder[i]].material);
        }
    const std::vector<TextureAnswer> found = ask(queries);
    for (size_t i = 0; i < materials.size(); ++i) {
        const TextureQuery& q = queries[isHeld ? i : 2 * i];
        const std::vector<TextureUse>& uses = scene_.materials[materials[i]].textures;
        const glm::dvec4 right = expected(uses[0], q.u, q.v);
        const double red = expected(uses[1], q.u, q.v).x,
                     opacity = isHeld && uses[1].scale < 0 ? 1 - red : red,
                     alpha = isHeld ? found[i].alpha : found[2 * i + 1].color.x;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[isHeld ? i : 2 * i].color[c], right[c], 1e-5 + 1.2e-4 * right[c]);
        EXPECT_NEAR(alpha, opacity, 1e-5 + 1.2e-4 * opacity) << "material " << materials[i];
    }
}

INSTANTIATE_TEST_SUITE_P(Fetch, TextureLookup,
                         testing::Values(TextureStorage{true, Gathered::All},
                                         TextureStorage{false, Gathered::All},
                                         TextureStorage{true, Gathered::Some},
                                         TextureStorage{true, Gathered::None},
                                         TextureStorage{false, Gathered::None}),
                         [](const auto& p) {
                             const std::string gathered = p.param.gathered == Gathered::All ? ""
                                                          : p.param.gathered == Gathered::Some
                                                              ? "PartlyPlain"
                                                              : "Plain";
                             return (p.param.texelBuffers ? "Texel" : "Storage") + gathered;
                         });

} // namespace
} // namespace stromboli::test
