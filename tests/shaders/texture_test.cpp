// Textures as the kernel looks them up, and as the reference does, against the definition: the
// picture goes on for ever, as its wrap modes say, and bilinear filtering is a sum over all texels
// by tents of one texel's width.
#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/texture_types.h"
#include "tests/analytic/textured.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/texture_storage.h"
#include "embedded/texture_texel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

using gpu::TextureAnswer;
using gpu::TextureQuery;

constexpr uint32_t kWidth = 5, kHeight = 3;

/// Index of a texel of the picture that goes on for ever.
uint32_t wrappedIndex(int64_t i, Wrap wrap, int64_t n) {
    if (wrap == Wrap::Clamp) return uint32_t(std::clamp<int64_t>(i, 0, n - 1));
    const int64_t period = wrap == Wrap::Mirror ? 2 * n : n;
    const int64_t within = (i % period + period) % period;
    return uint32_t(within < n ? within : period - 1 - within);
}

/// How many textures are stored so that a row holds what is looked up together.
enum class Gathered { All, Some, None };

uint64_t gatheredRows(Gathered gathered) {
    // Some: the first two pictures of the fixture, with three wraps of each direction.
    constexpr uint64_t kRows = uint64_t(kHeight + 1) * (kWidth + 2) * 18;
    return gathered == Gathered::All ? kUsualGatheredRows : gathered == Gathered::Some ? kRows : 0;
}

struct Storage {
    bool texelBuffers;
    Gathered gathered;
};

class TextureLookup : public DeviceTest, public testing::WithParamInterface<Storage> {
  protected:
    /// One triangle for each kind of texture.
    void SetUp() override {
        DeviceTest::SetUp();
        Random random(7);
        SceneMaker b;
        TextureMaker t(b.scene);
        std::vector<glm::vec4> texels;
        for (uint32_t i = 0; i < kWidth * kHeight; ++i)
            texels.emplace_back(random.uniform(), random.uniform(), random.uniform(),
                                random.uniform());
        const uint32_t images[] = {t.bytes(kWidth, kHeight, texels),
                                   t.halves(kWidth, kHeight, texels)};
        const uint32_t one = t.bytes(1, 1, {texels[0]});
        for (const uint32_t image : {images[0], images[1], one})
            for (const Wrap u : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
                for (const Wrap v : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
                    for (const bool nearest : {false, true})
                        for (const bool srgb : {false, true})
                            if (!srgb || image != images[1])
                                t.texture({.image = image,
                                           .wrapU = u,
                                           .wrapV = v,
                                           .nearest = nearest,
                                           .srgb = srgb});
        // A material for each, as a material has one texture of a slot.
        for (uint32_t i = 0; i < b.scene.textures.size(); ++i) {
            Material m;
            m.textures = {{.slot = TextureSlot::BaseColor,
                           .texture = i,
                           .uRow = {0.5f, 0.25f, -0.125f},
                           .vRow = {-0.75f, 1, 0.5f}}};
            b.triangle({0, 0, float(i)}, {1, 0, float(i)}, {0, 1, float(i)}, b.add(m));
            t.attributes(1, [](const glm::vec3& p) {
                VertexAttributes a;
                a.uv[0] = {p.x, p.y};
                return a;
            });
        }
        scene_ = b.scene;
        pack();
        const uint32_t kinds = gpu::TEXEL_KIND_PLAIN | gpu::TEXEL_KIND_GATHERED;
        ASSERT_EQ(packed_.texelKinds & kinds,
                  GetParam().gathered == Gathered::All    ? gpu::TEXEL_KIND_GATHERED
                  : GetParam().gathered == Gathered::None ? gpu::TEXEL_KIND_PLAIN
                                                          : kinds);
        for (const gpu::Primitive& p : packed_.primitives)
            rowOf_.push_back(materialOf(p) + gpu::MATERIAL_DETAIL_ROW + 1);
        for (size_t i = 0; i < rowOf_.size(); ++i)
            textureOf_.push_back(
                scene_.materials[scene_.triangles[packed_.bvh.primitiveOrder[i]].material]
                    .textures[0]);
    }

    void pack() {
        packed_ =
            packScene(scene_, buildWideBvh(scene_), {}, {}, gatheredRows(GetParam().gathered));
    }

    std::vector<TextureAnswer> ask(const std::vector<TextureQuery>& queries) const {
        ShaderOptions options = GetParam().texelBuffers ? ShaderOptions::texel() : ShaderOptions();
        options.set(SPEC_TEXEL_KINDS, packed_.texelKinds).set(SPEC_ATTRIBUTES, packed_.attributes);
        options.set(SPEC_TEXTURE_SLOTS, packed_.textureSlots);
        options.set(SPEC_LOOSE_SLOTS, packed_.looseSlots);
        TestShader shader(GetParam().texelBuffers ? std::span<const uint32_t>(texture_texel)
                                                  : std::span<const uint32_t>(texture_storage),
                          options);
        shader.setScene(packed_);
        return test::ask<TextureAnswer>(shader, queries);
    }

    /// The definition.
    glm::dvec4 expected(const TextureUse& use, double u, double v) const {
        const Texture& t = scene_.textures[use.texture];
        const TextureImage& image = scene_.images[t.image];
        const glm::dvec3 uv1(u, v, 1);
        const double x = glm::dot(glm::dvec3(use.uRow), uv1) * image.width,
                     y = glm::dot(glm::dvec3(use.vRow), uv1) * image.height;
        const auto texel = [&](int64_t i, int64_t j) {
            return texelAt(image, t.srgb, wrappedIndex(i, t.wrapU, image.width),
                           wrappedIndex(j, t.wrapV, image.height));
        };
        if (t.nearest) return texel(int64_t(std::floor(x)), int64_t(std::floor(y)));
        glm::dvec4 sum(0.0);
        for (int64_t j = int64_t(std::floor(y)) - 2; j <= int64_t(std::floor(y)) + 2; ++j)
            for (int64_t i = int64_t(std::floor(x)) - 2; i <= int64_t(std::floor(x)) + 2; ++i)
                sum += std::max(0.0, 1 - std::abs(x - 0.5 - double(i))) *
                       std::max(0.0, 1 - std::abs(y - 0.5 - double(j))) * texel(i, j);
        return sum;
    }

    Scene scene_;
    GpuScene packed_;
    std::vector<uint32_t> rowOf_; ///< of each primitive's texture
    std::vector<TextureUse> textureOf_;
};

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
        // Of the fit or of fractions of 65,535, and of two roundings of numbers up to 1.
        const double error =
            packed_.texelKinds & gpu::TEXEL_KIND_SRGB ? 1.1e-4 * linear : 0.5 / 65535;
        EXPECT_NEAR(found[size_t(i)].color.x, linear, error + 0x1p-23) << i;
    }
    EXPECT_EQ(found.front().color.x, 0);
    EXPECT_EQ(found.back().color.x, 1);
}

/// The channels that a map of a bundle has, of the four that a texture has.
std::vector<int> channelsOf(TextureSlot slot, bool hasAlpha) {
    if (slot == TextureSlot::MetallicRoughness) return {1, 2};
    if (slot == TextureSlot::BaseColor && hasAlpha) return {0, 1, 2, 3};
    return {0, 1, 2};
}

float channel(const TextureAnswer& a, int c) {
    return c < 3 ? a.color[c] : a.alpha;
}

constexpr TextureSlot kBundled[] = {TextureSlot::BaseColor, TextureSlot::MetallicRoughness,
                                    TextureSlot::Normal, TextureSlot::Emission};

/// The maps of a bundle are what the same pictures are by themselves, but for the rounding of
/// stored numbers; a map that the bundle lacks is white. Bundles with emission, with base colors
/// whose alpha counts, with both and with neither.
TEST_P(TextureLookup, BundlesHoldTheSameTextures) {
    if (GetParam().gathered != Gathered::All) GTEST_SKIP() << "there is no room for bundles";
    Random random(13);
    SceneMaker b;
    TextureMaker t(b.scene);
    const auto addMaterial = [&](const std::vector<TextureUse>& uses, bool isBlended) {
        Material m;
        m.kind = MaterialKind::Principled;
        m.emission = glm::vec3(1);
        m.alphaMode = isBlended ? AlphaMode::Blend : AlphaMode::Opaque;
        m.textures = uses;
        const auto z = float(b.scene.materials.size());
        b.triangle({0, 0, z}, {1, 0, z}, {0, 1, z}, b.add(m));
        t.attributes(1, [](const glm::vec3&) { return VertexAttributes{}; });
        return uint32_t(b.scene.materials.size() - 1);
    };
    struct Pair {
        uint32_t bundle, alone; ///< materials
        TextureSlot slot;
        bool hasAlpha;
    };
    std::vector<Pair> pairs;
    std::vector<Pair> lacking; ///< alone: without meaning
    for (const bool nearest : {false, true}) {
        std::vector<TextureUse> uses;
        for (const TextureSlot slot : kBundled) {
            std::vector<glm::vec4> texels;
            for (uint32_t i = 0; i < kWidth * kHeight; ++i)
                texels.emplace_back(random.uniform(), random.uniform(), random.uniform(),
                                    random.uniform());
            const bool isColor = slot == TextureSlot::BaseColor || slot == TextureSlot::Emission;
            uses.push_back({.slot = slot,
                            .texture = t.texture({.image = t.bytes(kWidth, kHeight, texels),
                                                  .wrapV = Wrap::Mirror,
                                                  .nearest = nearest,
                                                  .srgb = isColor}),
                            .uRow = {0.5f, 0.25f, -0.125f}});
        }
        std::vector<uint32_t> alone;
        for (const TextureUse& use : uses) {
            alone.push_back(addMaterial({use}, false));
            for (const TextureSlot slot : kBundled)
                lacking.push_back({alone.back(), 0, slot, true});
        }
        for (const bool hasEmission : {false, true})
            for (const bool hasAlpha : {false, true}) {
                std::vector<TextureUse> maps(uses.begin(), uses.end() - (hasEmission ? 0 : 1));
                const uint32_t bundle = addMaterial(maps, hasAlpha);
                for (size_t i = 0; i < maps.size(); ++i)
                    pairs.push_back({bundle, alone[i], maps[i].slot, hasAlpha});
                if (!hasEmission) lacking.push_back({bundle, 0, TextureSlot::Emission, hasAlpha});
            }
        const uint32_t two = addMaterial({uses[0], uses[2]}, false);
        pairs.push_back({two, alone[0], TextureSlot::BaseColor, false});
        pairs.push_back({two, alone[2], TextureSlot::Normal, false});
        lacking.push_back({two, 0, TextureSlot::MetallicRoughness, false});
        const uint32_t dark = addMaterial({uses[1], uses[3]}, false);
        pairs.push_back({dark, alone[3], TextureSlot::Emission, false});
        lacking.push_back({dark, 0, TextureSlot::BaseColor, false});
        lacking.push_back({dark, 0, TextureSlot::Normal, false});
    }
    scene_ = b.scene;
    pack();
    std::vector<uint32_t> rowOfMaterial(scene_.materials.size());
    for (size_t i = 0; i < packed_.primitives.size(); ++i)
        rowOfMaterial[scene_.triangles[packed_.bvh.primitiveOrder[i]].material] =
            materialOf(packed_.primitives[i]) + gpu::MATERIAL_DETAIL_ROW + 1;
    constexpr size_t kPlaces = 64;
    std::vector<TextureQuery> bundled, loose, missing;
    const auto queryOf = [&](const Pair& p) {
        const auto u = float(4 * random.uniform() - 2), v = float(4 * random.uniform() - 2);
        return TextureQuery{rowOfMaterial[p.bundle], u, v, uint32_t(p.slot) + 1};
    };
    for (const Pair& p : pairs)
        for (size_t k = 0; k < kPlaces; ++k) {
            bundled.push_back(queryOf(p));
            loose.push_back({rowOfMaterial[p.alone] + gpu::TEXTURE_USE_ROWS, bundled.back().u,
                             bundled.back().v, 0});
        }
    for (const Pair& p : lacking)
        for (size_t k = 0; k < kPlaces; ++k)
            missing.push_back(queryOf(p));
    const std::vector<TextureAnswer> a = ask(bundled), e = ask(loose), white = ask(missing);
    for (size_t i = 0; i < a.size(); ++i) {
        const Pair& p = pairs[i / kPlaces];
        const bool isColor = p.slot == TextureSlot::BaseColor || p.slot == TextureSlot::Emission;
        for (const int c : channelsOf(p.slot, p.hasAlpha)) {
            const float alone = channel(e[i], c);
            // Roots are of 4095, rounded to half: a square within root / 4095, and of the mean of
            // texels within the root of the mean. The picture's own texels are fractions of 65,535.
            const double error =
                0x1p-22 + (isColor && c < 3 ? std::sqrt(alone) / 4095 + 1.0 / 65535 : 0.0);
            EXPECT_NEAR(channel(a[i], c), alone, error)
                << "slot " << uint32_t(p.slot) << ", channel " << c << ", material " << p.bundle;
        }
    }
    for (size_t i = 0; i < white.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_EQ(channel(white[i], c), 1) << "slot " << uint32_t(lacking[i / kPlaces].slot);
}

INSTANTIATE_TEST_SUITE_P(Fetch, TextureLookup,
                         testing::Values(Storage{true, Gathered::All},
                                         Storage{false, Gathered::All},
                                         Storage{true, Gathered::Some},
                                         Storage{true, Gathered::None},
                                         Storage{false, Gathered::None}),
                         [](const auto& p) {
                             const std::string gathered = p.param.gathered == Gathered::All ? ""
                                                          : p.param.gathered == Gathered::Some
                                                              ? "PartlyPlain"
                                                              : "Plain";
                             return (p.param.texelBuffers ? "Texel" : "Storage") + gathered;
                         });

} // namespace
} // namespace stromboli::test
