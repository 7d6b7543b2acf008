// Textures in a bundle, as the kernel looks them up, against the same ones by themselves.
#include "tests/shaders/texture_lookup.hpp"

#include "host/core/random.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/texture_types.h"
#include "tests/analytic/textured.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

class BundleLookup : public TextureLookup {};

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
/// whose alpha counts, with both and with neither, and of one map.
TEST_P(BundleLookup, HoldsTheSameTextures) {
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
            for (uint32_t i = 0; i < kTextureWidth * kTextureHeight; ++i)
                texels.emplace_back(random.uniform(), random.uniform(), random.uniform(),
                                    random.uniform());
            const bool isColor = slot == TextureSlot::BaseColor || slot == TextureSlot::Emission;
            uses.push_back(
                {.slot = slot,
                 .texture = t.texture({.image = t.bytes(kTextureWidth, kTextureHeight, texels),
                                       .wrapV = Wrap::Mirror,
                                       .nearest = nearest,
                                       .srgb = isColor}),
                 .uRow = {0.5f, 0.25f, -0.125f}});
        }
        std::vector<uint32_t> alone;
        for (const TextureUse& use : uses) {
            TextureUse inAnother = use;
            inAnother.slot = TextureSlot::Specular; // which no bundle has
            alone.push_back(addMaterial({inAnother}, false));
            const uint32_t one = addMaterial({use}, false);
            pairs.push_back({one, alone.back(), use.slot, false});
            for (const TextureSlot slot : kBundled) {
                lacking.push_back({alone.back(), 0, slot, true});
                if (slot != use.slot) lacking.push_back({one, 0, slot, true});
            }
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

INSTANTIATE_TEST_SUITE_P(Fetch, BundleLookup,
                         testing::Values(TextureStorage{true, Gathered::All},
                                         TextureStorage{false, Gathered::All}),
                         [](const auto& p) { return p.param.texelBuffers ? "Texel" : "Storage"; });

} // namespace
} // namespace stromboli::test
