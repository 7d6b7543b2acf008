#pragma once

#include "host/cli/option_list.hpp"
#include "host/cli/options.hpp"

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace stromboli {

/// A command with its options.
struct DeclaredCommand {
    std::string name, description, footer;
    OptionList list;
    HostOptions host;
    std::set<std::string> given; ///< names of the options on the command line
    /// The command as it decides on the picture (RenderOptions::command).
    std::vector<std::string> pictureCommand;
    /// Works out what the options mean together. Throws UsageError.
    std::function<CommandOptions()> finish;

    bool has(const std::string& option) const { return given.contains(option); }
    /// Those of the options that are on the command line: "-m, -l"; empty: none.
    std::string givenOf(const std::vector<std::string>& names) const;
};

/// All commands. The functions inside refer to their own command: it must not be moved.
std::deque<DeclaredCommand> declareCommands();

/// Understands the words of the command line (without the program's name): stores them in the
/// command that they name, and checks conflicts. Null: help or version was printed and the program
/// is done. Throws UsageError.
DeclaredCommand* parseCommand(std::deque<DeclaredCommand>& commands, const Words& words);

// Each command declares its options in the file that runs it.

void declareRender(DeclaredCommand& command);
void declareCheck(DeclaredCommand& command);
void declareInfo(DeclaredCommand& command);
void declareKernels(DeclaredCommand& command);
void declareDevices(DeclaredCommand& command);
void declareBench(DeclaredCommand& command);
void declareStress(DeclaredCommand& command);
void declareCompare(DeclaredCommand& command);
void declareStudy(DeclaredCommand& command);
void declareMerge(DeclaredCommand& command);
void declarePlan(DeclaredCommand& command);
void declareSubmit(DeclaredCommand& command);

// Groups of options that several commands have. Each stores what it understands in the structure it
// is given. A `finish...` belongs to the group of its name.

/// Which pictures a command makes.
enum class Makes {
    Pictures, ///< or parts of them, by one command or several machines
    NoPicture ///< it looks at one, or measures
};

/// What was asked for, before it is known what it means together with the rest.
struct Asked {
    Makes makes = Makes::NoPicture;
    bool maySpread = false;    ///< samples may go where they help most
    bool branchesPay = false;  ///< the scene says how many branches there are, where nobody does
    uint32_t usualPaths = 64;  ///< -s where it is not given
    bool usuallySpread = true; ///< samples go where they help most
    std::optional<uint32_t> paths;
    bool adaptive = false, even = false;
    uint32_t pathsPerBlock = 128; ///< of an even render
    std::optional<Crop> cell;     ///< y counts from the bottom of the picture
    std::optional<uint32_t> accumulate;
    std::vector<std::string> cameras; ///< RenderOptions::cameras
    SampleName sample;
    bool sampleAlone = false; ///< `sample` and nothing else
};

/// several: where a command takes more than one scene; their names go there, and not into `scene`.
void declareScene(OptionList& list, SceneRequest& scene, Words* several = nullptr);

/// What is said of the file that a picture is written to.
void declarePictureFile(OptionList& list, OutputOptions& output, ToneCurve& tone);
/// Throws UsageError if the kind of the picture has no use for --exposure, --aov or --layers.
void checkOutputOptions(const DeclaredCommand& command, const OutputOptions& output,
                        const RenderRequest& picture);
/// --transparent, --layers.
void declareSeen(OptionList& list, RenderRequest& picture);

/// Size, camera, crop; of a command that makes several pictures also several cameras.
void declarePicture(OptionList& list, RenderRequest& picture, Asked& asked, bool several = false);
void finishPicture(const DeclaredCommand& command, RenderRequest& picture, const Asked& asked,
                   bool several = false);
void declareSequence(OptionList& list, SequenceOptions& sequence);

/// What the estimator is, and --cs184.
void declareEstimator(OptionList& list, SceneAndPicture& work, Asked& asked);
void finishEstimator(DeclaredCommand& command, SceneAndPicture& work, const Asked& asked);

void declareSampler(OptionList& list, Sampler& where);
/// -s, --sampler, --seed.
void declareSamples(OptionList& list, RenderRequest& picture, Asked& asked,
                    const std::string& samplesHelp);
/// usually: the default, in words.
void declareBranches(OptionList& list, RenderRequest& picture, const std::string& usually);
/// --block.
CommandOption& declareBlock(OptionList& list, Asked& asked);
/// --noise.
CommandOption& declareNoise(OptionList& list, const std::string& help, double& where);
/// Where samples go and when it is enough: --even, -a, --noise, --time.
void declareSpreading(OptionList& list, RenderRequest& picture, Asked& asked);
/// Works out the budget of the picture.
void finishBudget(RenderRequest& picture, const Asked& asked);

/// The `finish` of a command that looks at the picture that its options ask for, and at no other.
template <class LookingOptions>
void finishesAsPicture(DeclaredCommand& command, std::shared_ptr<LookingOptions> options,
                       std::shared_ptr<Asked> asked) {
    command.finish = [&command, options, asked] {
        finishPicture(command, options->picture, *asked);
        finishEstimator(command, *options, *asked);
        finishBudget(options->picture, *asked);
        return *options;
    };
}

/// --film-memory.
void declareFilmMemory(OptionList& list, DeviceRequest& device);
void declareDevice(OptionList& list, std::string& device);
/// Threads and how much is said.
void declareHost(DeclaredCommand& command);

/// The words of an option that takes names, with commas between them.
Words splitAtCommas(const std::string& word);

} // namespace stromboli
