#pragma once

#include "host/cli/options.hpp"
#include "host/core/text.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stromboli {

// --- Options -------------------------------------------------------------------------------------

using Words = std::vector<std::string>;

template <class T>
struct Range {
    T least, most;
};

/// "1 to 1024".
std::string inWords(Range<uint32_t> range);
std::string inWords(Range<double> range);

/// What may stand behind a number, and how many of the option's own units that is.
struct Unit {
    const char* name;
    double factor;
};
/// The larger before the smaller.
using Units = std::span<const Unit>;
inline constexpr Unit kTimes[] = {{"h", 3600}, {"min", 60}, {"m", 60}, {"s", 1}, {"ms", 1e-3}};
inline constexpr Unit kLengths[] = {{"km", 1e3}, {"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}};
inline constexpr Unit kShares[] = {{"%", 0.01}};
inline constexpr Unit kPercents[] = {{"%", 1}};
inline constexpr Unit kMebibytes[] = {
    {"TiB", 1 << 20}, {"GiB", 1024}, {"G", 1024}, {"MiB", 1}, {"M", 1}};
inline constexpr Unit kDegrees[] = {{"rad", 57.29577951308232}, {"deg", 1}, {"\u00b0", 1}};

/// A number as host/core/text.hpp says, or one or more with units behind them, the larger first:
/// "90", "1.5min", "1h30m". A letter that is a unit here is no power of ten. Empty if the word is
/// none of these.
std::optional<double> quantityIn(std::string_view word, Units units);

/// A whole number in a range, written as host/core/text.hpp says. Throws UsageError that
/// names the option and the range.
uint32_t readNumber(const std::string& option, const std::string& word, Range<uint32_t> range);
/// A real number in a range, likewise, or a quantity; NaN and infinity are none.
double readReal(const std::string& option, const std::string& word, Range<double> range,
                Units units = {});

/// Throws the UsageError that `option` is `word` where one of `expected` was to be.
[[noreturn]] void refuse(const std::string& option, const std::string& word,
                         const std::string& expected);

/// Throws the UsageError that `option` is `word` where one of these names was to be: which may have
/// been meant, and which there are.
[[noreturn]] void refuseName(const std::string& option, const std::string& word, const Words& names,
                             const std::string& namesInWords);

/// The names in the table of an enumeration.
template <class E>
Words namesOf() {
    Words names;
    for (const NamedValue<E>& row : kNamedValues<E>)
        names.emplace_back(row.name);
    return names;
}

/// What completion in a shell proposes for the words of an option, beside its `proposals`.
enum class Proposed { Nothing, Files, Folders, Scenes };

/// One option of a command, and all there is to say about it: what it is called, which words it
/// takes, what it means, where that is stored, and what it does not go with.
class CommandOption {
  public:
    /// Another option that cannot be given too, and why (may be empty).
    struct Conflict {
        std::string option;
        std::string reason;
    };

    /// The default in words, for --help, where it is not a value that is stored from the start.
    CommandOption& usually(std::string text);
    /// Takes numbers from this range, as inWords() puts it.
    CommandOption& from(std::string numbers);
    CommandOption& excludes(std::string option, std::string reason = "");
    /// Cannot be given without the other.
    CommandOption& needs(std::string option);
    /// Says this flag too.
    CommandOption& implies(std::string option);
    CommandOption& required();
    /// Changes the defaults of other options, to these words of theirs as --help says them, where a
    /// command has them: is stored before them, wherever it stands.
    CommandOption& changesDefaults(std::vector<std::pair<std::string, std::string>> words = {});
    /// Has no effect on the picture: its notes leave it out.
    CommandOption& besidePicture();
    /// Is understood, but not listed by --help, the manual page and completion.
    CommandOption& hidden();
    /// Two numbers that may also be one word with an x between them: 640x360.
    CommandOption& maybeJoined();
    /// A word, or two whole numbers, which are stored as one word with a comma: 320,180.
    CommandOption& maybeApart();
    /// Its word may be missing, and is then this one: a word behind it that is none of its own
    /// belongs to others.
    CommandOption& maybeWithout(std::string word, std::function<bool(const std::string&)> isItsOwn);
    /// Is among the few that --help lists first.
    CommandOption& common();
    /// Words that completion proposes. Others may be understood too.
    CommandOption& proposes(Words words);
    CommandOption& proposes(Proposed what);

    /// The name that messages call it by, which is its first one.
    std::string name() const;
    /// {"-l", "--light-samples"}; none: by position.
    Words dashedNames() const;
    /// Its help with the range and the default.
    std::string fullHelp() const;

    std::string names;      ///< "-l,--light-samples"; without dashes: by position
    std::string valueNames; ///< of its words, as "W H"; empty: a flag
    std::string help, group, usual;
    std::string range;     ///< of its numbers, in words; empty: it takes none
    std::string ifMissing; ///< its word where it has none; empty: it must have one
    std::function<bool(const std::string&)> isItsOwn; ///< with ifMissing: a word behind it
    uint32_t wordCount = 1;
    bool anyNumber = false, separatedByCommas = false, mayRepeat = false;
    bool isRequired = false, isHidden = false, isFirst = false, isBesidePicture = false;
    bool isCommon = false, mayBeJoined = false, mayBeApart = false;
    std::vector<Conflict> conflicts;
    std::vector<std::string> needed, implied;
    std::vector<std::pair<std::string, std::string>> changedDefaults; ///< option, its default then
    Proposed proposed = Proposed::Nothing;
    Words proposals;
    /// Understands the words and keeps what they say. Throws UsageError.
    std::function<void(const Words&)> store;
};

/// The options of a command in the order in which --help lists them.
class OptionList {
  public:
    /// A heading of --help for the options declared from here on.
    void group(std::string name) { group_ = std::move(name); }

    CommandOption& flag(std::string names, std::string help, bool& where);
    CommandOption& flag(std::string names, std::string help, std::function<void()> store);
    /// An option that takes the word on or off.
    CommandOption& onOff(std::string names, std::string help, bool& where);
    CommandOption& text(std::string names, std::string valueName, std::string help,
                        std::string& where);
    CommandOption& number(std::string names, std::string valueName, std::string help,
                          uint32_t& where, Range<uint32_t> range);
    CommandOption& number(std::string names, std::string valueName, std::string help,
                          std::optional<uint32_t>& where, Range<uint32_t> range);
    /// An option that takes as many whole numbers as `where` has places.
    CommandOption& numbers(std::string names, std::string valueNames, std::string help,
                           std::vector<uint32_t*> where, Range<uint32_t> range);
    /// units: what may stand behind the number.
    CommandOption& real(std::string names, std::string valueName, std::string help, double& where,
                        Range<double> range, Units units = {});
    CommandOption& real(std::string names, std::string valueName, std::string help,
                        std::optional<double>& where, Range<double> range, Units units = {});
    /// A value of an enumeration with a table of names; --help lists what they mean.
    template <class E>
    CommandOption& choice(std::string names, std::string valueName, std::string help, E& where) {
        CommandOption& o = words(std::move(names), std::move(valueName),
                                 std::move(help) + " (" + allMeanings<E>() + ")", 1, {});
        o.usual = nameOf(where);
        o.proposals = namesOf<E>();
        o.store = [&where, name = o.name()](const Words& given) {
            const std::optional<E> value = valueNamed<E>(given.front());
            if (!value) refuseName(name, given.front(), namesOf<E>(), allNames<E>());
            where = *value;
        };
        return o;
    }
    /// Any number of words: one or more by position, or separated by commas, or repeated.
    CommandOption& list(std::string names, std::string valueName, std::string help, Words& where);
    /// An option that understands its `count` words by itself.
    CommandOption& words(std::string names, std::string valueNames, std::string help,
                         uint32_t count, std::function<void(const Words&)> store);

    const std::deque<CommandOption>& all() const { return options_; }
    /// Makes options common (CommandOption::common), by any of their names. Throws std::logic_error
    /// for a name that none has.
    void makeCommon(const Words& names);
    /// Once all are declared: has --help say which defaults change by other options
    /// (CommandOption::changesDefaults).
    void sayChangedDefaults();

  private:
    std::string group_;
    std::deque<CommandOption> options_; ///< references to its elements stay valid
};

// --- Commands ------------------------------------------------------------------------------------

/// A command with its options.
struct DeclaredCommand {
    std::string name, description, group, footer;
    std::vector<std::string> examples; ///< whole command lines, which the footer has too
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
void declareRegress(DeclaredCommand& command);
void declareCompare(DeclaredCommand& command);
void declareStudy(DeclaredCommand& command);
void declareMerge(DeclaredCommand& command);
void declarePlan(DeclaredCommand& command);
void declareSubmit(DeclaredCommand& command);
void declareTonemap(DeclaredCommand& command);
void declareDenoise(DeclaredCommand& command);
void declareView(DeclaredCommand& command);

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
    PixelQuestion pixel;
    bool pixelAlone = false; ///< `pixel` and nothing else
};

/// Radiance: one number for all channels, or three with commas between. Empty if it is no such
/// text.
std::optional<glm::vec3> readRadiance(const std::string& word);

/// several: where a command takes more than one scene; their names go there, and not into `scene`.
void declareScene(OptionList& list, SceneRequest& scene, Words* several = nullptr);

/// How radiance becomes a picture for a screen.
void declareToneMapping(OptionList& list, ToneMapping& tone, PictureEncoding& encoding);
/// Names of the options that declareToneMapping() declares.
const Words& toneMappingOptions();
/// Throws UsageError if the kind of the picture has no use for one of them that is given.
void checkToneMapping(const DeclaredCommand& command, const OutputOptions& output);

/// What is said of the file that a picture is written to, and how radiance becomes one.
void declarePictureFile(OptionList& list, OutputOptions& output, ToneMapping& tone);
/// Names of the options that declarePictureFile() declares.
Words pictureFileOptions();
/// Those of a command's parts (DeclaredCommand::pictureCommand) that are such an option.
Words partsOfPictureFile(const Words& command);
/// Whether the picture's file says how it was made.
void declareNotes(OptionList& list, OutputOptions& output);
/// Throws UsageError if the kind of the picture has no use for what is asked for.
void checkOutputOptions(const DeclaredCommand& command, const OutputOptions& output,
                        const RenderRequest& picture);
/// --transparent, --layers.
void declareSeen(OptionList& list, RenderRequest& picture);
void finishSeen(const DeclaredCommand& command, SceneRequest& scene, RenderRequest& picture);

/// Size, camera, crop; of a command that makes several pictures also several cameras.
void declarePicture(OptionList& list, RenderRequest& picture, Asked& asked, bool several = false);
void finishPicture(const DeclaredCommand& command, RenderRequest& picture, const Asked& asked,
                   bool several = false);
void declareSequence(OptionList& list, SequenceOptions& sequence);

/// What the estimator is, and whose conventions.
void declareEstimator(OptionList& list, SceneAndPicture& work, Asked& asked);
void finishEstimator(DeclaredCommand& command, SceneAndPicture& work, const Asked& asked);

void declareSampler(OptionList& list, Sampler& where);
/// -s, --sampler, --seed.
void declareSamples(OptionList& list, RenderRequest& picture, Asked& asked,
                    const std::string& samplesHelp);
/// --clamp-indirect.
void declareClamp(OptionList& list, RenderRequest& picture);
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
