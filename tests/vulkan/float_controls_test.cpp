// Modules that ask for what GLSL cannot ask for.
#include "host/vulkan/instance.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/shell.hpp"

#include "embedded/pathtrace_storage.h"
#include "embedded/trace_rays_texel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace stromboli::vulkan {
namespace {

using testing::HasSubstr;
using Words = std::vector<uint32_t>;

const std::span<const uint32_t> kModules[] = {pathtrace_storage, trace_rays_texel};

/// What spirv-val says of the module; empty: it is valid.
std::string complaint(const Words& code) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.spv", std::ios::binary)
        .write(reinterpret_cast<const char*>(code.data()),
               std::streamsize(code.size() * sizeof(uint32_t)));
    const test::ShellRun run =
        test::shell(STROMBOLI_SPIRV_VAL " --target-env vulkan1.1 " + (folder / "a.spv").string());
    return run.exitCode == 0 ? "" : "invalid: " + run.output;
}

/// The instructions of an opcode, with their operands.
std::vector<Words> instructions(const Words& code, uint32_t opcode) {
    std::vector<Words> found;
    for (size_t i = 5; i < code.size(); i += code[i] >> 16)
        if ((code[i] & 0xFFFF) == opcode)
            found.emplace_back(code.begin() + ptrdiff_t(i) + 1,
                               code.begin() + ptrdiff_t(i + (code[i] >> 16)));
    return found;
}

bool contains(const std::vector<Words>& all, const Words& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

/// The validator takes seconds for the large module, which it is given with all that can be asked
/// for.
TEST(FloatControls, ModulesThatAskAreValid) {
    for (const auto& module : kModules)
        for (const FloatControls& c : {FloatControls{true, true}, {true, false}, {false, true}}) {
            const Words code = withFloatControls(module, c);
            const bool isLarge = module.data() == kModules[0].data();
            if (!isLarge || (c.preservesSpecialValues && c.roundsToEven)) {
                EXPECT_EQ(complaint(code), "");
            }
            const uint32_t entry = instructions(code, 15).at(0).at(1);
            EXPECT_EQ(contains(instructions(code, 17), {4466}), c.preservesSpecialValues);
            EXPECT_EQ(contains(instructions(code, 17), {4467}), c.roundsToEven);
            EXPECT_EQ(contains(instructions(code, 16), {entry, 4461, 32}),
                      c.preservesSpecialValues);
            EXPECT_EQ(contains(instructions(code, 16), {entry, 4462, 32}), c.roundsToEven);
            EXPECT_EQ(instructions(code, 54).size(), // functions
                      instructions({module.begin(), module.end()}, 54).size());
        }
}

TEST(FloatControls, WhatADeviceLacksIsNotAskedFor) {
    for (const auto& module : kModules)
        EXPECT_EQ(withFloatControls(module, {}), Words(module.begin(), module.end()));
}

/// The validator would have seen the mode without the capability.
TEST(FloatControls, TheValidatorSees) {
    Words code = withFloatControls(kModules[1], {true, true});
    for (size_t i = 5; i < code.size(); i += code[i] >> 16)
        if (code[i] == (2u << 16 | 17u) && code[i + 1] == 4466) code[i + 1] = 1; // Shader
    EXPECT_THAT(complaint(code), HasSubstr("SignedZeroInfNanPreserve"));
}

TEST(FloatControls, WhatIsNoModuleStaysAsItIs) {
    const Words broken = {0x07230203, 0x10300, 0, 10, 0, 5u << 16 | 17u, 1};
    for (const Words& code : {Words{}, Words{1, 2, 3, 4, 5, 6}, broken})
        EXPECT_EQ(withFloatControls(code, {true, true}), code);
}

TEST(FloatControls, AreSaidInWords) {
    EXPECT_EQ(inWords({true, true}), "NaN, infinity and -0 kept, rounding to nearest even");
    EXPECT_EQ(inWords({false, true}), "rounding to nearest even");
    EXPECT_THAT(inWords({}), HasSubstr("nothing promised"));
}

} // namespace
} // namespace stromboli::vulkan
