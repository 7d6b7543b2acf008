// Modules with their constants in place: valid, smaller, and the same whatever else the source
// holds.
#include "host/spirv/specialise.hpp"
#include "tests/spirv/modules.hpp"

#include "embedded/decided_shader.h"
#include "embedded/pathtrace_storage.h"
#include "embedded/pathtrace_texel.h"
#include "embedded/pathtrace_with_feature.h"
#include "embedded/trace_rays_storage.h"
#include "embedded/trace_rays_texel.h"
#include "embedded/wavefront_storage.h"
#include "embedded/wavefront_texel.h"
#include "embedded/ways_shader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace stromboli {
namespace {

using namespace test;

struct Module {
    const char* name;
    Code code;
};
const Module kModules[] = {{"pathtrace_storage", pathtrace_storage},
                           {"pathtrace_texel", pathtrace_texel},
                           {"trace_rays_storage", trace_rays_storage},
                           {"trace_rays_texel", trace_rays_texel}};

const Module kPathModules[] = {{"pathtrace_storage", pathtrace_storage},
                               {"pathtrace_texel", pathtrace_texel},
                               {"wavefront_storage", wavefront_storage},
                               {"wavefront_texel", wavefront_texel}};

size_t countOf(const Words& code, uint32_t opcode) {
    size_t count = 0;
    for (size_t i = 5; i < code.size(); i += code[i] >> 16)
        count += (code[i] & 0xFFFF) == opcode;
    return count;
}

class SpecialisedKernel : public testing::TestWithParam<const char*> {};

TEST_P(SpecialisedKernel, IsValidAndHasNoConstantsLeft) {
    // With everything on the kernels of all scenes are nearly one.
    const bool isRich = std::string_view(GetParam()) == "still_life";
    for (const bool everythingOn : {false, true})
        for (const Module& m : kModules) {
            if (everythingOn && !isRich) continue;
            const auto made = spirv::specialise(m.code, featuresOf(GetParam(), everythingOn));
            ASSERT_TRUE(made) << m.name;
            EXPECT_EQ(complaint(*made), "") << m.name << (everythingOn ? ", everything on" : "");
            for (const uint32_t opcode : {48u, 49u, 50u, 51u}) // specialisation constants
                EXPECT_EQ(countOf(*made, opcode), 0u) << m.name;
            EXPECT_EQ(made, spirv::specialise(*made, {})) << m.name << ": a second time changes it";
        }
}

#ifdef STROMBOLI_SANITIZED
const char* const kSpecialisedFor[] = {"still_life"};
#else
const char* const kSpecialisedFor[] = {"cornell_boxes", "cornell_mesh",        "still_life",
                                       "island",        "generate:points:100", "generate:forest:3"};
#endif
INSTANTIATE_TEST_SUITE_P(Scenes, SpecialisedKernel, testing::ValuesIn(kSpecialisedFor),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             std::erase_if(name, [](char c) { return !std::isalnum(uint8_t(c)); });
                             return name;
                         });

/// How often a buffer of constants is read at a place that the module states. Lavapipe puts the
/// values of such constants into the kernel, and makes it anew in every dispatch: still_life took
/// half as long again, and 30 MB more of memory each second.
size_t constantsAtKnownPlaces(const Words& code) {
    constexpr uint32_t kConstant = 43, kVariable = 59, kAccessChain = 65, kInBounds = 66,
                       kHeader = 5;
    constexpr uint32_t kUniform = 2, kPushConstant = 9;
    std::set<uint32_t> constants, buffers;
    size_t found = 0;
    for (size_t i = kHeader; i < code.size(); i += code[i] >> 16) {
        const uint32_t opcode = code[i] & 0xFFFF, words = code[i] >> 16;
        if (opcode == kConstant) constants.insert(code[i + 2]);
        if (opcode == kVariable && (code[i + 3] == kUniform || code[i + 3] == kPushConstant))
            buffers.insert(code[i + 2]);
        if ((opcode != kAccessChain && opcode != kInBounds) || !buffers.contains(code[i + 3]))
            continue;
        found += words < 6 || constants.contains(code[i + 5]); // the block's array, and the place
    }
    return found;
}

TEST(Specialise, NoDriverKnowsWhichConstantsADispatchReads) {
    for (const Module& m : kPathModules) {
        const auto made = spirv::specialise(m.code, featuresOf("still_life"));
        ASSERT_TRUE(made) << m.name;
        EXPECT_EQ(constantsAtKnownPlaces(*made), 0u) << m.name;
    }
    const auto rays = spirv::specialise(trace_rays_texel, {});
    EXPECT_GT(constantsAtKnownPlaces(*rays), 0u) << "the test finds nothing";
}

TEST(Specialise, TheCornellBoxHasATenthOfTheKernel) {
    const auto made = spirv::specialise(pathtrace_texel, featuresOf("cornell_boxes"));
    ASSERT_TRUE(made);
    EXPECT_LT(10 * made->size(), std::size(pathtrace_texel));
}

/// A feature that a scene does not have costs it nothing, neither code nor a word of state.
TEST(Specialise, AFeatureThatIsSwitchedOffLeavesNoTrace) {
    Words constants = featuresOf("cornell_boxes");
    constants.push_back(0);
    const auto without = spirv::specialise(pathtrace_storage, constants),
               with = spirv::specialise(pathtrace_with_feature, constants);
    ASSERT_TRUE(without && with);
    EXPECT_GT(std::size(pathtrace_with_feature), std::size(pathtrace_storage));
    EXPECT_TRUE(*without == *with) << without->size() << " and " << with->size() << " words";
    constants.back() = 1;
    const auto switchedOn = spirv::specialise(pathtrace_with_feature, constants);
    ASSERT_TRUE(switchedOn);
    EXPECT_GT(switchedOn->size(), without->size());
    EXPECT_EQ(complaint(*switchedOn), "");
}

TEST(Specialise, ConstantsThatAreNotGivenKeepTheirDefaults) {
    const Words defaults = {1, 3, uint32_t(-7), 0, 2, 0x3FC00000u};
    EXPECT_EQ(spirv::specialise(decided_shader, {}), spirv::specialise(decided_shader, defaults));
    EXPECT_EQ(spirv::specialise(decided_shader, Code(defaults).first(3)),
              spirv::specialise(decided_shader, {}));
    Words other = defaults;
    other[1] = 4;
    EXPECT_NE(spirv::specialise(decided_shader, {}), spirv::specialise(decided_shader, other));
}

constexpr uint32_t kSwitch = 251, kLoopMerge = 246, kLoad = 61;

/// Mesa makes a loop of each switch that is left from within, and unrolls one nest of loops in each
/// round of all its passes.
TEST(Specialise, EarlyReturnsAreNoSwitchesAndCountedLoopsNoLoops) {
    const Words before(std::begin(ways_shader), std::end(ways_shader));
    EXPECT_EQ(countOf(before, kSwitch), 5u);
    EXPECT_EQ(countOf(before, kLoopMerge), 11u);
    for (const uint32_t returnsEarly : {0u, 1u}) {
        const auto made = spirv::specialise(ways_shader, Words{1, 3, returnsEarly});
        ASSERT_TRUE(made);
        EXPECT_EQ(complaint(*made), "");
        // Left is a return out of a selection in a selection of which the other ways go on.
        EXPECT_EQ(countOf(*made, kSwitch), returnsEarly);
        // Those with a return, a break and a `continue`, and one of a number of times that is not
        // known.
        EXPECT_EQ(countOf(*made, kLoopMerge), 3u + returnsEarly);
    }
}

/// How many results drivers may not fuse with others: `precise` in GLSL.
size_t exactResultsOf(const Words& code) {
    constexpr uint32_t kDecorate = 71, kNoContraction = 42;
    size_t count = 0;
    for (size_t i = 5; i < code.size(); i += code[i] >> 16)
        count += (code[i] & 0xFFFF) == kDecorate && code[i + 2] == kNoContraction;
    return count;
}

/// What is exact in a loop is exact in each copy of it; else triangles would not be watertight
/// where drivers fuse products and sums.
TEST(Specialise, WhatIsExactStaysSoInUnrolledLoops) {
    const Words before(std::begin(ways_shader), std::end(ways_shader));
    const auto made = spirv::specialise(ways_shader, {});
    ASSERT_TRUE(made);
    EXPECT_EQ(exactResultsOf(before), 2u);
    EXPECT_EQ(exactResultsOf(*made), 3 * exactResultsOf(before));
    const auto kernel = spirv::specialise(pathtrace_storage, featuresOf("cornell_boxes"));
    ASSERT_TRUE(kernel);
    EXPECT_GT(exactResultsOf(*kernel), 60u) << "triangles and boxes";
}

/// By spirv-opt, which knows nothing of this program's passes, hardly a load is left whose value is
/// known.
TEST(Specialise, StoredValuesAreNotLoadedAgain) {
    for (const char* scene : {"cornell_boxes", "still_life"}) {
        const auto made = spirv::specialise(pathtrace_storage, featuresOf(scene));
        ASSERT_TRUE(made);
        const Words less =
            optimised(*made, "--eliminate-local-single-block --eliminate-local-single-store");
        EXPECT_GT(countOf(less, kLoad), countOf(*made, kLoad) * 95 / 100) << "of " << scene;
    }
}

/// The driver gets such modules as they are.
TEST(Specialise, WhatIsNotUnderstoodIsLeftAlone) {
    EXPECT_FALSE(spirv::specialise({}, {}));
    EXPECT_FALSE(spirv::specialise(Code(decided_shader).first(5), {}));
    Words broken(std::begin(decided_shader), std::end(decided_shader));
    broken[0] ^= 1;
    EXPECT_FALSE(spirv::specialise(broken, {})) << "another magic number";
    broken[0] ^= 1;
    Words cut = broken;
    cut.resize(cut.size() - 2);
    EXPECT_FALSE(spirv::specialise(cut, {})) << "the function has no end";
    constexpr uint32_t kOpGroupAll = 261;
    broken.insert(broken.end() - 1, {4u << 16 | kOpGroupAll, 1, 1, 1});
    EXPECT_FALSE(spirv::specialise(broken, {})) << "an instruction that the grammar does not know";
}

} // namespace
} // namespace stromboli
