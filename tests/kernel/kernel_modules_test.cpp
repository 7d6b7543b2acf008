// Which module of the path kernel is taken, and that none fixes a constant which differs.
#include "host/kernel/kernel_modules.hpp"

#include <gtest/gtest.h>

#include <set>

namespace stromboli {
namespace {

/// The ids of specialisation constants that a module has: OpDecorate <id> SpecId <n>.
std::set<uint32_t> constantsOf(std::span<const uint32_t> module) {
    constexpr uint32_t kHeader = 5, kOpDecorate = 71, kSpecId = 1;
    std::set<uint32_t> ids;
    for (size_t i = kHeader; i < module.size(); i += module[i] >> 16)
        if ((module[i] & 0xFFFF) == kOpDecorate && module[i + 2] == kSpecId)
            ids.insert(module[i + 3]);
    return ids;
}

/// A path tracer of a scene with one light.
KernelFeatures usual() {
    KernelFeatures f{};
    f[SPEC_LIGHT_CHOICE] = gpu::LIGHT_CHOICE_ONE;
    return f;
}

class KernelModules : public testing::TestWithParam<bool> {
  protected:
    std::span<const uint32_t> module(const KernelFeatures& f) const {
        return kernelModule(f, GetParam());
    }
};

TEST_P(KernelModules, TheSmallestThatHasAllFeatures) {
    KernelFeatures f = usual();
    const auto one = module(f);
    f[SPEC_LIGHT_CHOICE] = gpu::LIGHT_CHOICE_TREE;
    const auto many = module(f);
    f[SPEC_CS184] = 1;
    const auto all = module(f);
    EXPECT_LT(one.size(), 0.9 * double(many.size()));
    EXPECT_LT(many.size(), 0.95 * double(all.size()));
    f[SPEC_ALPHA] = 1;
    const auto rich = module(f);
    EXPECT_LT(all.size(), 0.95 * double(rich.size()));
    EXPECT_EQ(constantsOf(rich).size(), size_t(SPEC_COUNT) - 1);
    f[SPEC_BSDF_KINDS] = 1u << gpu::BSDF_CONDUCTOR;
    const auto facets = module(f);
    EXPECT_LT(rich.size(), 0.95 * double(facets.size()));
    EXPECT_EQ(constantsOf(facets).size(), size_t(SPEC_COUNT)) << "all constants are used";
    f[SPEC_BSDF_KINDS] = 0;
    f[SPEC_CS184] = 0;
    EXPECT_LT(module(f).size(), 0.95 * double(rich.size())) << "of usual modes";
    const auto rare = constantsOf(all);
    for (const uint32_t id : {SPEC_TEXTURE_SLOTS,
                              SPEC_LOOSE_SLOTS,
                              SPEC_TEXEL_KINDS,
                              SPEC_ATTRIBUTES,
                              SPEC_ALPHA,
                              SPEC_TANGENT_FRAMES,
                              SPEC_BLENDS,
                              SPEC_RELIEF_RULES,
                              SPEC_HAS_ENVIRONMENT,
                              SPEC_HAS_BACKDROP,
                              SPEC_HAS_LENS,
                              SPEC_PIXEL_FILTER,
                              SPEC_PRINCIPLED_FEATURES,
                              SPEC_FACETS,
                              SPEC_HAS_PLACEMENTS,
                              SPEC_TRAVERSAL_LEGS,
                              SPEC_FILTER_EXTRA,
                              SPEC_HIDES_SURFACES,
                              SPEC_FLAT_TERMINATOR,
                              SPEC_LOOSE_TEXTURES,
                              SPEC_WAITING_PART,
                              SPEC_CORNER_NORMALS})
        EXPECT_FALSE(rare.contains(id)) << id;
    EXPECT_EQ(rare.size(), size_t(SPEC_COUNT) - 22);
}

/// A constant with another value than the usual one leads to a module that has the constant. With
/// one light nothing asks for the groups of a light tree, without placements nothing for legs.
TEST_P(KernelModules, NoneFixesAConstantThatDiffers) {
    for (uint32_t id = 0; id < SPEC_COUNT; ++id) {
        KernelFeatures f = usual();
        for (const uint32_t value : {1u, 2u, 3u}) {
            f[id] = usual()[id] + value;
            EXPECT_EQ(constantsOf(module(f)).contains(id),
                      id != SPEC_LIGHT_GROUPS && id != SPEC_TRAVERSAL_LEGS)
                << id << " is " << f[id];
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Fetch, KernelModules, testing::Bool(), [](const auto& texelFetch) {
    return texelFetch.param ? "Texel" : "Storage";
});

} // namespace
} // namespace stromboli
