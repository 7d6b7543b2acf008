// Which textures of a material are packed together (gpu::TEXELS_BUNDLE), and which are left by
// themselves.
#include "host/kernel/detail_plan.hpp"
#include "shaders/shared/interface.h"

#include <gtest/gtest.h>

#include <functional>

namespace stromboli::test {
namespace {

constexpr uint32_t bit(TextureSlot slot) {
    return 1u << uint32_t(slot);
}

class Bundles : public testing::Test {
  protected:
    Bundles() {
        scene_.images = {{.width = 4, .height = 2, .words = std::vector<uint32_t>(8)},
                         {.width = 2, .height = 4, .words = std::vector<uint32_t>(8)},
                         {.width = 4,
                          .height = 2,
                          .format = TexelFormat::RgbaHalf,
                          .words = std::vector<uint32_t>(16)}};
        scene_.materials.resize(1);
        Material& m = scene_.materials[0];
        m.kind = MaterialKind::Principled;
        m.emission = glm::vec3(1);
        m.principled.clearcoat = 1;
        add(TextureSlot::BaseColor, {.srgb = true});
        add(TextureSlot::Normal, {});
    }

    void add(TextureSlot slot, const Texture& texture) {
        scene_.materials[0].textures.push_back(
            {.slot = slot, .texture = uint32_t(scene_.textures.size())});
        scene_.textures.push_back(texture);
    }

    DetailPlan plan() const { return planDetails(scene_, {true}); }

    Scene scene_;
};

TEST_F(Bundles, TakeTwoThatAreLookedUpAlike) {
    const DetailPlan p = plan();
    ASSERT_TRUE(p.materials[0].bundle);
    const DetailPlan::Bundle& bundle = *p.materials[0].bundle;
    EXPECT_TRUE(bundle[gpu::TEXTURE_BASE_COLOR] && bundle[gpu::TEXTURE_NORMAL]);
    EXPECT_FALSE(bundle[gpu::TEXTURE_METALLIC_ROUGHNESS] || bundle[gpu::TEXTURE_EMISSION]);
    EXPECT_TRUE(p.materials[0].textures.empty());
    EXPECT_EQ(p.textureSlots, bit(TextureSlot::BaseColor) | bit(TextureSlot::Normal));
    EXPECT_EQ(p.looseSlots, 0u);
    EXPECT_EQ(p.mostTextures, 0u);
    EXPECT_TRUE(p.texelKinds & gpu::TEXEL_KIND_BUNDLE);
    EXPECT_FALSE(p.texelKinds & gpu::TEXEL_KIND_LOOSE);
}

TEST_F(Bundles, LeaveTheRestLoose) {
    add(TextureSlot::Clearcoat, {});
    add(TextureSlot::Emission, {.image = 1, .srgb = true});
    const DetailPlan p = plan();
    EXPECT_TRUE(p.materials[0].bundle);
    ASSERT_EQ(p.materials[0].textures.size(), 2u);
    EXPECT_EQ(p.materials[0].textures[0].slot, TextureSlot::Emission) << "in the order of slots";
    EXPECT_EQ(p.looseSlots, bit(TextureSlot::Emission) | bit(TextureSlot::Clearcoat));
    EXPECT_EQ(p.mostTextures, 2u);
    EXPECT_TRUE(p.texelKinds & gpu::TEXEL_KIND_LOOSE);
}

/// Where a material has a bundle all look one up, so that a picture by itself is best in one too.
/// The largest of several groups that are alike is taken.
TEST_F(Bundles, TakePicturesByThemselvesWhereOthersHaveOne) {
    scene_.materials.push_back(scene_.materials[0]);
    scene_.materials[1].textures.resize(1);
    const DetailPlan p = planDetails(scene_, {true, true});
    ASSERT_TRUE(p.materials[0].bundle && p.materials[1].bundle);
    EXPECT_TRUE((*p.materials[1].bundle)[gpu::TEXTURE_BASE_COLOR]);
    EXPECT_FALSE((*p.materials[1].bundle)[gpu::TEXTURE_NORMAL]);
    EXPECT_EQ(p.looseSlots, 0u);
    EXPECT_EQ(p.mostTextures, 0u);
    EXPECT_FALSE(planDetails(scene_, {false, true}).materials[1].bundle) << "no other has one";

    scene_.textures[0].image = 1;
    add(TextureSlot::MetallicRoughness, {});
    const DetailPlan largest = plan();
    ASSERT_TRUE(largest.materials[0].bundle);
    EXPECT_TRUE((*largest.materials[0].bundle)[gpu::TEXTURE_NORMAL]);
    EXPECT_TRUE((*largest.materials[0].bundle)[gpu::TEXTURE_METALLIC_ROUGHNESS]);
    EXPECT_EQ(largest.looseSlots, bit(TextureSlot::BaseColor));
}

/// Whatever differs between two textures keeps them apart.
TEST_F(Bundles, AreOfOneKind) {
    using Change = std::function<void(Texture&, TextureUse&)>;
    const std::pair<const char*, Change> changes[] = {
        {"size", [](Texture& t, TextureUse&) { t.image = 1; }},
        {"format", [](Texture& t, TextureUse&) { t.image = 2; }},
        {"wrap of columns", [](Texture& t, TextureUse&) { t.wrapU = Wrap::Clamp; }},
        {"wrap of rows", [](Texture& t, TextureUse&) { t.wrapV = Wrap::Mirror; }},
        {"filter", [](Texture& t, TextureUse&) { t.nearest = true; }},
        {"decoding", [](Texture& t, TextureUse&) { t.srgb = !t.srgb; }},
        {"set of coordinates", [](Texture&, TextureUse& u) { u.uvSet = 1; }},
        {"columns", [](Texture&, TextureUse& u) { u.uRow.x = 2; }},
        {"rows", [](Texture&, TextureUse& u) { u.vRow.z = 0.5f; }},
    };
    const Scene alike = scene_;
    for (const size_t which : {size_t(0), size_t(1)})
        for (const auto& [name, change] : changes) {
            scene_ = alike;
            TextureUse& use = scene_.materials[0].textures[which];
            change(scene_.textures[use.texture], use);
            EXPECT_FALSE(plan().materials[0].bundle) << name;
            EXPECT_EQ(plan().materials[0].textures.size(), 2u) << name;
        }
}

/// The kernel knows wrap modes that no texture has, and reads neither transforms nor scales where
/// none changes anything.
TEST_F(Bundles, TellWhatLookupsNeed) {
    const uint32_t asked = gpu::TEXEL_KIND_REPEAT | gpu::TEXEL_KIND_MIRROR | gpu::TEXEL_KIND_CLAMP |
                           gpu::TEXEL_KIND_ADJUSTED;
    EXPECT_EQ(plan().texelKinds & asked, gpu::TEXEL_KIND_REPEAT);
    scene_.textures[0].wrapV = Wrap::Mirror;
    EXPECT_EQ(plan().texelKinds & asked, gpu::TEXEL_KIND_REPEAT | gpu::TEXEL_KIND_MIRROR);
    for (Texture& t : scene_.textures)
        t.wrapU = t.wrapV = Wrap::Clamp;
    EXPECT_EQ(plan().texelKinds & asked, gpu::TEXEL_KIND_CLAMP);
    TextureUse& use = scene_.materials[0].textures[1];
    const TextureUse usual = use;
    for (const auto& change :
         {+[](TextureUse& u) { u.uRow.y = 0.5f; }, +[](TextureUse& u) { u.vRow.z = 0.5f; },
          +[](TextureUse& u) { u.scale = 0.5f; }}) {
        use = usual;
        change(use);
        EXPECT_EQ(plan().texelKinds & asked, gpu::TEXEL_KIND_CLAMP | gpu::TEXEL_KIND_ADJUSTED);
    }
}

/// What changes nothing takes no memory either.
TEST_F(Bundles, HaveOnlyWhatHasAnEffect) {
    scene_.materials[0].principled.baseColor = glm::vec3(0);
    EXPECT_FALSE(plan().materials[0].bundle);
    EXPECT_EQ(plan().looseSlots, bit(TextureSlot::Normal));
}

/// An opacity beside a base colour, both by themselves.
class Opacities : public testing::Test {
  protected:
    Opacities() {
        const std::vector<uint32_t> opaque(8, 0xFF804020u), halves(16, 0x3C003800u);
        scene_.images = {
            {.width = 4, .height = 2, .words = opaque},
            {.width = 4, .height = 2, .words = opaque},
            {.width = 4, .height = 2, .format = TexelFormat::RgbaHalf, .words = halves}};
        scene_.textures = {{.image = 0, .srgb = true}, {.image = 1}};
        scene_.materials.resize(1);
        Material& m = scene_.materials[0];
        m.alphaMode = AlphaMode::Blend;
        m.textures = {{.slot = TextureSlot::BaseColor, .texture = 0},
                      {.slot = TextureSlot::Opacity, .texture = 1}};
    }

    bool areOne(uint64_t rows = kUsualGatheredRows) const {
        const DetailPlan p = planDetails(scene_, {true}, rows);
        EXPECT_EQ(p.mostTextures, p.materials[0].opacity ? 1u : 2u);
        EXPECT_EQ((p.looseSlots & bit(TextureSlot::Opacity)) == 0,
                  p.materials[0].opacity.has_value());
        return p.materials[0].opacity.has_value();
    }

    Scene scene_;
};

TEST_F(Opacities, AreTheAlphaOfColorsThatAreLookedUpAlike) {
    EXPECT_TRUE(areOne());
    EXPECT_FALSE(areOne(0)) << "there is no room";
    scene_.textures[1].image = 2;
    EXPECT_TRUE(areOne());
    scene_.textures[0].image = 2;
    EXPECT_TRUE(areOne());
}

TEST_F(Opacities, StayByThemselvesOtherwise) {
    const Scene same = scene_;
    const std::function<void()> changes[] = {
        [&] { scene_.images[0].words[3] = 0x00FFFFFF; },
        [&] { scene_.textures[1].wrapV = Wrap::Clamp; },
        [&] { scene_.textures[1].nearest = true; },
        [&] { std::swap(scene_.images[1].width, scene_.images[1].height); },
        [&] {
            scene_.materials[0].textures[1].uRow = {2, 0, 0};
        },
        [&] { scene_.materials[0].textures[1].uvSet = 1; },
    };
    for (const std::function<void()>& change : changes) {
        change();
        EXPECT_FALSE(areOne()) << "change " << &change - changes;
        scene_ = same;
    }
    // Brighter than 1: no fraction.
    scene_.textures[1].image = 2;
    scene_.images[2].words[4] = 0x3C004200;
    EXPECT_FALSE(areOne());
}

/// Of an opacity red alone counts, and by its difference: edges of leaves are nearly transparent.
TEST_F(Opacities, AreOfAnyRedUpToOne) {
    scene_.textures[1].image = 2;
    for (const uint32_t low : {0x42000001u, 0x00003C00u, 0x7E000000u}) {
        scene_.images[2].words[4] = low;
        EXPECT_TRUE(areOne()) << low;
    }
    scene_.images[2].words[4] = 0x3C01;
    EXPECT_FALSE(areOne());
}

/// Where opacity is compared with a cutoff it is that of the picture, exactly: 0.75 is no fraction.
TEST_F(Opacities, OfMasksStayHalfFloats) {
    Material& m = scene_.materials[0];
    const auto isHalf = [&] {
        return (planDetails(scene_, {true}).texelKinds & gpu::TEXEL_KIND_HALF) != 0;
    };
    EXPECT_TRUE(areOne());
    m.alphaMode = AlphaMode::Mask;
    EXPECT_TRUE(areOne()) << "bytes are fractions exactly";
    scene_.textures[1].image = 2;
    EXPECT_FALSE(areOne());
    EXPECT_TRUE(isHalf());
    m.textures = {{.slot = TextureSlot::BaseColor, .texture = 1}};
    EXPECT_TRUE(isHalf()) << "the alpha of a colour";
    m.alphaMode = AlphaMode::Blend;
    EXPECT_FALSE(isHalf());
}

/// From 2^-6 to 1, and 0; alpha from 0 on.
TEST_F(Opacities, HalfFloatsAreFractionsWhereTheseAreAsExact) {
    const auto isHalf = [&](uint32_t low, uint32_t high) {
        scene_.materials[0].textures = {{.slot = TextureSlot::BaseColor, .texture = 0}};
        scene_.textures[0].image = 2;
        scene_.images[2].words[6] = low, scene_.images[2].words[7] = high;
        const DetailPlan p = planDetails(scene_, {true});
        EXPECT_NE((p.texelKinds & gpu::TEXEL_KIND_HALF) != 0,
                  (p.texelKinds & gpu::TEXEL_KIND_BYTES) != 0);
        return (p.texelKinds & gpu::TEXEL_KIND_HALF) != 0;
    };
    EXPECT_FALSE(isHalf(0x24003C00, 0x00010000));
    EXPECT_TRUE(isHalf(0x23FF3C00, 0x3C000000)) << "a green below 2^-6";
    EXPECT_TRUE(isHalf(0x3C003C01, 0x3C000000)) << "a red above 1";
    EXPECT_TRUE(isHalf(0, 0x3C00BC00)) << "a blue below 0";
    EXPECT_TRUE(isHalf(0, 0x3C010000)) << "an alpha above 1";
    EXPECT_TRUE(isHalf(0x7E00, 0)) << "not a number";
}

/// Textures for which there is no room are in no bundle, and what has none then is stored plainly.
/// What is shared counts once.
TEST_F(Bundles, StayWithinTheirRoom) {
    scene_.materials.resize(2, scene_.materials[0]); // share a bundle
    scene_.materials.push_back(scene_.materials[0]);
    const std::vector<bool> used(3, true);
    for (TextureUse& use : scene_.materials[2].textures) {
        Texture other = scene_.textures[use.texture];
        other.image = use.slot == TextureSlot::BaseColor ? 1 : 3;
        use.texture = uint32_t(scene_.textures.size());
        scene_.textures.push_back(other);
    }
    scene_.images.push_back(scene_.images[1]); // 2 x 4
    constexpr uint64_t kFirst = 6 * 4, kSecond = 4 * 6, kLoose = 4 * 5;
    const auto kinds = [](const DetailPlan& p) {
        return p.texelKinds & (gpu::TEXEL_KIND_PLAIN | gpu::TEXEL_KIND_GATHERED);
    };
    DetailPlan p = planDetails(scene_, used, kFirst + kSecond);
    EXPECT_TRUE(p.materials[0].bundle && p.materials[1].bundle && p.materials[2].bundle);
    EXPECT_EQ(kinds(p), 0u);
    p = planDetails(scene_, used, kFirst + kSecond - 1);
    EXPECT_TRUE(p.materials[0].bundle && p.materials[1].bundle);
    EXPECT_FALSE(p.materials[2].bundle);
    EXPECT_EQ(p.materials[2].textures.size(), 2u);
    EXPECT_EQ(p.plainImages.size(), 1u) << "there is room for one of the two";
    EXPECT_EQ(kinds(p), gpu::TEXEL_KIND_PLAIN | gpu::TEXEL_KIND_GATHERED);
    p = planDetails(scene_, used, kFirst + kLoose - 1);
    EXPECT_EQ(p.plainImages.size(), 2u);
    EXPECT_EQ(kinds(p), uint32_t(gpu::TEXEL_KIND_PLAIN));
    p = planDetails(scene_, used, 0);
    EXPECT_FALSE(p.hasBundles());
    EXPECT_EQ(p.plainImages.size(), 4u)
        << "one of the three is sRGB in one slot and not in the other";
}

} // namespace
} // namespace stromboli::test
