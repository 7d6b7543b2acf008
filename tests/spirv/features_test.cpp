// Every feature of the table (shaders/shared/features.h), switched on and off: the kernel changes,
// stays valid, and holds nothing of what is off.
#include "host/kernel/kernel_features.hpp"
#include "host/spirv/specialise.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/spirv/modules.hpp"
#include "tests/support/shell.hpp"

#include "embedded/pathtrace_storage.h"
#include "embedded/wavefront_storage.h"
#include "shaders/shared/wavefront_types.h"
#include "source_dir.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace stromboli {
namespace {

using namespace test;
using Kind = FeatureValue::Kind;

/// In two kernels that differ as far as can be, and one of a rich scene: what has no effect beside
/// one has some beside another.
const std::vector<Words>& bases() {
    static const std::vector<Words> all = [] {
        Words everything = featuresOf("cornell_boxes", true);
        // Off: what takes the place of others.
        const std::set<uint32_t> off = {SPEC_ORTHOGRAPHIC, SPEC_FLAT_TERMINATOR,
                                        SPEC_STACK_IN_REGISTERS};
        for (const Feature& f : featureTable()) {
            if (f.shown.kind == Kind::Flag) everything[f.constant] = !off.contains(f.constant);
            if (f.shown.kind == Kind::Bits)
                everything[f.constant] = (1u << f.shown.names.size()) - 1;
        }
        everything[SPEC_DEPARTURES] = 0;
        everything[SPEC_LIGHT_CHOICE] = gpu::LIGHT_CHOICE_TREE;
        everything[SPEC_LOOSE_TEXTURES] = 4;
        everything[SPEC_PIXEL_FILTER] = gpu::FILTER_TENT;
        return std::vector<Words>{featuresOf("cornell_boxes"), everything,
                                  featuresOf("still_life", true)};
    }();
    return all;
}

std::vector<uint32_t> otherValues(const Feature& f, uint32_t value) {
    std::vector<uint32_t> others;
    switch (f.shown.kind) {
    case Kind::Flag:
        return {value ^ 1u};
    case Kind::Count:
        return {value + 1, 1};
    case Kind::Share:
    case Kind::Number:
        return {std::bit_cast<uint32_t>(0.25f)};
    case Kind::Bits:
        for (uint32_t bit = 0; bit < f.shown.names.size(); ++bit)
            others.push_back(value ^ 1u << bit);
        return others;
    case Kind::Choice:
        for (uint32_t choice = 0; choice < f.shown.names.size(); ++choice)
            if (choice != value) others.push_back(choice);
        return others;
    }
    return others;
}

Words specialised(Code code, const Words& constants) {
    const auto made = spirv::specialise(code, constants);
    return made ? *made : Words();
}

class SwitchedFeature : public testing::TestWithParam<Feature> {};

/// Some other value of it makes another kernel of one of these.
TEST_P(SwitchedFeature, ChangesAKernelThatStaysValid) {
    const Feature& f = GetParam();
    bool changes = false;
    for (size_t i = 0; i < bases().size() && !changes; ++i) {
        static std::vector<Words> kernels(bases().size());
        if (kernels[i].empty()) kernels[i] = specialised(pathtrace_storage, bases()[i]);
        const uint32_t own = bases()[i][f.constant];
        Words flipped = bases()[i];
        flipped[f.constant] = own ^ ((1u << f.shown.names.size()) - 1);
        // Where all bits together change nothing none of them does alone.
        const bool isIdle = i == 0 && f.shown.kind == Kind::Bits &&
                            specialised(pathtrace_storage, flipped) == kernels[i];
        for (const uint32_t value : isIdle ? std::vector<uint32_t>{} : otherValues(f, own)) {
            Words values = bases()[i];
            values[f.constant] = value;
            const Words made = specialised(pathtrace_storage, values);
            if (made == kernels[i]) continue;
            EXPECT_EQ(complaint(made), "") << f.name << " = " << value;
            changes = true;
            if (i > 0) break; // a large kernel, which takes a second to check
        }
    }
    EXPECT_TRUE(changes) << f.name << ": no value of it makes another kernel";
}

/// All of them; one in twelve under sanitizers.
std::vector<Feature> featuresToTry() {
    std::vector<Feature> features = featureTable();
#ifdef STROMBOLI_SANITIZED
    size_t index = 0;
    std::erase_if(features, [&](const Feature&) { return index++ % 12 != 0; });
#endif
    return features;
}

INSTANTIATE_TEST_SUITE_P(Table, SwitchedFeature, testing::ValuesIn(featuresToTry()),
                         [](const auto& feature) { return std::string(feature.param.name); });

/// The source of a kernel with all includes.
std::string sourceOf(const std::string& file) {
    const ShellRun run = shell(STROMBOLI_GLSLANG " -E -I" STROMBOLI_SOURCE_DIR
                                                 "/shaders " STROMBOLI_SOURCE_DIR "/shaders/" +
                               file);
    EXPECT_EQ(run.exitCode, 0) << run.output;
    return run.output;
}

/// The path kernel's, but for constants of features that these values switch off: they are plain
/// constants in it, which no host can switch on.
std::string sourceWithout(const Words& values) {
    std::string source = sourceOf("pathtrace.comp");
    for (const Feature& f : featureTable()) {
        const bool isFlag = f.shown.kind == Kind::Flag;
        const bool hasSwitch = isFlag || f.shown.kind == Kind::Bits || f.constant == SPEC_FOCI;
        if (values[f.constant] != 0 || !hasSwitch) continue;
        const std::regex declaration(
            fmt::format("layout\\(constant_id = {}\\) ?const (\\w+) {} = [^;]*;",
                        uint32_t(f.constant), f.name));
        EXPECT_TRUE(std::regex_search(source, declaration)) << f.name;
        source = std::regex_replace(
            source, declaration, fmt::format("const $1 {} = {};", f.name, isFlag ? "false" : "0u"));
    }
    return source;
}

/// As the build compiles shaders.
Words compiled(const std::string& source) {
    const TemporaryFolder folder;
    const std::string glsl = (folder / "a.comp").string(), spv = (folder / "a.spv").string();
    std::ofstream(glsl) << source;
    const ShellRun run =
        shell(fmt::format(STROMBOLI_GLSLANG " --quiet -V --target-env vulkan1.1 -o {1} {0} && " //
                          STROMBOLI_SPIRV_OPT " --target-env=vulkan1.1 {1} -o {1}",
                          glsl, spv));
    EXPECT_EQ(run.exitCode, 0) << run.output;
    return readWords(spv);
}

/// Without local variables, as drivers read a module: where a feature is switched off before the
/// build's passes, these dissolve some more of them than where the finished module lacks it.
Words dissolved(const Words& module) {
    return specialised(
        optimised(module, "--ssa-rewrite --eliminate-dead-code-aggressive --simplify-instructions "
                          "--eliminate-dead-code-aggressive --merge-blocks"),
        {});
}

/// What a scene lacks costs it nothing: its kernel is the same as if the shaders had never had it.
TEST(Features, WhatTheCornellBoxLacksLeavesNoTrace) {
    const Words values = featuresOf("cornell_boxes");
    const Words with = dissolved(specialised(pathtrace_storage, values)),
                without = dissolved(specialised(compiled(sourceWithout(values)), values));
    EXPECT_TRUE(with == without) << with.size() << " and " << without.size() << " words";
}

/// What the camera sees is an integrator of the same kernels. All that is asked for by its name is
/// cut out of the source here, and kernels of radiance are the same words: the specialiser leaves
/// nothing of it behind that the compiler would not. What stands outside of these conditions this
/// test cannot see; it changes radiance, or is dead.
TEST(Features, SeeingLeavesNoTraceInKernelsOfRadiance) {
    const std::regex asked("INTEGRATOR ?== ?INTEGRATOR_(COVERAGE|LAYERS)");
    struct Kernel {
        const char* file;
        Code code;
        uint32_t stages;
    };
    // What both kernels have of it is in the files that they share; the wavefront scheduler's has
    // some more. To run the build's passes on either takes seconds, and minutes under sanitizers.
    const std::vector<Kernel> kernels = {
#ifdef STROMBOLI_SANITIZED
        {"pathtrace.comp", pathtrace_storage, 1},
#else
        {"wavefront.comp", wavefront_storage, gpu::STAGE_COUNT},
#endif
    };
    for (const Kernel& k : kernels) {
        const std::string source = sourceOf(k.file);
        const std::string cut = std::regex_replace(source, asked, "false");
        EXPECT_NE(cut, source);
        const Words without = compiled(cut);
        EXPECT_LT(without.size(), k.code.size());
        for (const char* scene : {"cornell_boxes", "still_life"})
            for (uint32_t stage = 0; stage < k.stages; ++stage) {
                Words values = featuresOf(scene);
                values.push_back(stage); // SPEC_STAGE; the persistent kernel has no such constant
                EXPECT_TRUE(specialised(without, values) == specialised(k.code, values))
                    << k.file << ", " << scene << ", stage " << stage;
                if (k.stages > 1 && stage != gpu::STAGE_FOLLOW) continue;
                values[SPEC_INTEGRATOR] = gpu::INTEGRATOR_LAYERS;
                EXPECT_FALSE(specialised(without, values) == specialised(k.code, values))
                    << k.file << ", " << scene << ": has been cut out of all kernels";
            }
    }
}

} // namespace
} // namespace stromboli
