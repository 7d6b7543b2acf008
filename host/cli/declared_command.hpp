#pragma once

#include "host/cli/option_list.hpp"
#include "host/cli/options.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace stromboli {

/// What was asked for, before it is known what it means together with the rest.
struct Asked {
    uint32_t usualPaths = 64;  ///< -s where it is not given
    bool usuallySpread = true; ///< samples go where they help most
    std::optional<uint32_t> paths;
    bool adaptive = false, even = false;
    uint32_t pathsPerBlock = 128; ///< of an even render
    std::optional<Crop> cell;     ///< y counts from the bottom of the picture
    std::optional<uint32_t> accumulate;
    SampleName sample;
    bool sampleAlone = false; ///< `sample` and nothing else
};

/// A command with its options. Each has its own defaults: `options` and `asked` as they are when
/// the options are declared.
struct DeclaredCommand {
    std::string name, description, footer;
    Options options;
    Asked asked;
    OptionList list;
    std::set<std::string> given; ///< names of the options on the command line
    bool has(const std::string& option) const { return given.contains(option); }
    /// Those of the options that are on the command line: "-m, -l"; empty: none.
    std::string givenOf(const std::vector<std::string>& names) const;
    /// Works out what the options mean together. Throws UsageError.
    std::function<void()> finish = [] {};
};

/// All commands. The functions inside refer to their own command: it must not be moved.
std::deque<DeclaredCommand> declareCommands();

/// Understands the words of the command line (without the program's name): stores them in the
/// command that they name, checks conflicts, and finishes it. Null: help or version was printed and
/// the program is done. Throws UsageError.
DeclaredCommand* parseCommand(std::deque<DeclaredCommand>& commands, const Words& words);

// Groups of options that several commands have. Each `finish...` belongs to the group above it.

void declareScene(DeclaredCommand& command);

/// Views that files do not state: where from, which angle, which lens.
/// What is said of the file that a picture is written to.
void declarePictureFile(DeclaredCommand& command);
/// --transparent, --layers.
void declareSeen(DeclaredCommand& command);
void declareOptics(DeclaredCommand& command);
void declareSequence(DeclaredCommand& command);
void checkSequence(const DeclaredCommand& command);
/// Size, camera, crop.
void declarePicture(DeclaredCommand& command);
void finishPicture(DeclaredCommand& command);

/// What the estimator is, and --cs184.
void declareEstimator(DeclaredCommand& command);
void finishEstimator(DeclaredCommand& command);

void declareSampler(DeclaredCommand& command, Sampler& where);
/// -s, --sampler, --seed.
void declareSamples(DeclaredCommand& command, const std::string& samplesHelp);
/// usually: the default, in words.
void declareBranches(DeclaredCommand& command, const std::string& usually);
/// --block.
CommandOption& declareBlock(DeclaredCommand& command);
/// --noise.
CommandOption& declareNoise(DeclaredCommand& command, const std::string& help, double& where);
/// Where samples go and when it is enough: --even, -a, --noise, --time.
void declareSpreading(DeclaredCommand& command);
/// Throws UsageError if the kind of the picture has no use for --exposure, --aov or --layers.
void checkOutputOptions(const DeclaredCommand& command);
/// --share, and what belongs to it.
void declareShare(DeclaredCommand& command);
void finishShare(DeclaredCommand& command);
/// Works out the budget of a command whose samples may be spread, or not.
void finishBudget(DeclaredCommand& command, bool maySpread);
/// --pixel and --sample.
void declareSampleAlone(DeclaredCommand& command);

/// --film-memory.
void declareFilmMemory(DeclaredCommand& command);
void declareDevice(DeclaredCommand& command);
/// Threads and how much is said.
void declareHost(DeclaredCommand& command);

// Commands with options of their own.
void declareBench(DeclaredCommand& command);
void declareCompare(DeclaredCommand& command);
void declareMerge(DeclaredCommand& command);
void declarePlan(DeclaredCommand& command);
void declareStress(DeclaredCommand& command);
void declareStudy(DeclaredCommand& command);
void declareSubmit(DeclaredCommand& command);

} // namespace stromboli
