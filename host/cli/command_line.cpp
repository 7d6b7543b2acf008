#include "host/cli/command_line.hpp"

#include "host/cli/cs184_options.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/presets.hpp"
#include "host/cli/word_spelling.hpp"
#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"
#include "host/version/version.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>

namespace stromboli {

// --- The program in words ------------------------------------------------------------------------

std::string exitCodesInOneLine() {
    std::string text;
    for (const Explained& code : kExitCodes)
        text += std::string(text.empty() ? "" : ", ") + code.word + " " + code.meaning;
    return text;
}

std::string shortHelp() {
    std::string text = fmt::format("Stromboli {}: {}.\n\n", version(), kInOneLine);
    for (const Explained& command : kFirstCommands)
        text += fmt::format("  stromboli {:<39} {}\n", command.word, command.meaning);
    return text +
           "\n"
           "SCENE is a glTF, COLLADA, Mitsuba, pbrt, OBJ or PLY file, a bundled scene by its name, "
           "as\n"
           "cornell_mesh, or generate:cornell_mesh:100k, which is made in memory.\n"
           "\n"
           "Other commands: view, tonemap, denoise, devices, kernels, compare, regress, study, "
           "bench,\nstress, submit, merge, plan.\n"
           "'stromboli --help' says what each does, 'stromboli help COMMAND' lists its options.\n";
}

// --- Words of command lines ----------------------------------------------------------------------

std::string shellQuoted(const std::string& argument) {
    constexpr const char* kPlain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos)
        return argument;
    std::string text = "'";
    for (const char c : argument)
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

std::string commandLine() {
    std::ifstream file("/proc/self/cmdline");
    std::string text;
    for (std::string argument; std::getline(file, argument, '\0');)
        text += (text.empty() ? "" : " ") + shellQuoted(argument);
    return text;
}

// --- Parsing -------------------------------------------------------------------------------------

// Nothing else knows the library that splits the command line into options (CLI11).

namespace {

/// The words that followed each option that was given, by its name.
using Given = std::map<std::string, Words>;

/// The pieces of all words. Also those that are empty, which CLI11's own splitting leaves out: a
/// comma too many is a mistake.
Words splitAllAtCommas(const Words& words) {
    Words pieces;
    for (const std::string& word : words)
        for (std::string& piece : splitAtCommas(word))
            pieces.push_back(std::move(piece));
    return pieces;
}

/// The heading of --help that an option stands under; none: it is not listed.
std::string groupOf(const CommandOption& o) {
    return o.isHidden ? "" : o.isCommon ? "The usual ones" : o.group;
}

void declare(CLI::App& app, const CommandOption& o, Given& given) {
    if (o.wordCount == 0) {
        app.add_flag_function(
               o.names, [&given, name = o.name()](std::int64_t) { given[name] = {}; }, o.help)
            ->group(groupOf(o))
            ->disable_flag_override(); // "--even=false" would turn it on
        return;
    }
    CLI::Option* option = app.add_option(
        o.names,
        [&given, &o](const CLI::results_t& words) {
            given[o.name()] = o.separatedByCommas ? splitAllAtCommas(words) : words;
            return true;
        },
        o.fullHelp());
    option->group(groupOf(o));
    if (!o.valueNames.empty()) option->type_name(o.valueNames);
    if (o.isRequired) option->required();
    if (o.mayRepeat || o.separatedByCommas)
        option->type_size(1)->expected(1)->allow_extra_args(false)->multi_option_policy(
            CLI::MultiOptionPolicy::TakeAll);
    else if (o.anyNumber)
        option->type_size(1)->expected(-1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    else
        option->type_size(1)
            ->expected(int(o.wordCount))
            ->allow_extra_args(false)
            ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
}

void checkTogether(const CommandOption& o, const Given& given) {
    for (const CommandOption::Conflict& conflict : o.conflicts)
        if (given.count(conflict.option))
            throw UsageError(fmt::format("{} and {} exclude each other{}{}", o.name(),
                                         conflict.option, conflict.reason.empty() ? "" : ": ",
                                         conflict.reason));
    for (const std::string& other : o.needed)
        if (!given.count(other))
            throw UsageError(fmt::format("{} requires {} (see --help)", o.name(), other));
}

void addImplied(const OptionList& list, Given& given) {
    for (const CommandOption& o : list.all())
        if (given.count(o.name()))
            for (const std::string& flag : o.implied) {
                checkTogether(o, given); // before the flag is said to be in the way of another
                given.try_emplace(flag);
            }
}

/// The command as it decides on the picture, in the order of --help: however it was written, the
/// same picture has the same words.
std::vector<std::string> pictureCommandOf(const DeclaredCommand& command, const Given& given) {
    std::vector<std::string> parts = {"stromboli " + command.name};
    for (const CommandOption& o : command.list.all()) {
        const auto words = given.find(o.name());
        if (words == given.end() || o.isBesidePicture) continue;
        const std::string name = o.dashedNames().empty() ? "" : o.name();
        std::string part = name;
        for (size_t i = 0; i < words->second.size(); ++i) {
            if (i > 0 && o.mayRepeat) part += " " + name;
            part += (part.empty() ? "" : " ") + shellQuoted(words->second[i]);
        }
        parts.push_back(part);
    }
    return parts;
}

void store(const OptionList& list, const Given& given) {
    for (const CommandOption& o : list.all())
        if (given.count(o.name())) checkTogether(o, given);
    for (const bool first : {true, false})
        for (const CommandOption& o : list.all())
            if (const auto words = given.find(o.name()); words != given.end() && o.isFirst == first)
                o.store(words->second);
}

/// The first word has to be a command, or ask for help.
void checkCommandName(const std::deque<DeclaredCommand>& commands, const Words& arguments) {
    if (arguments.empty()) throw UsageError("a command is needed (see --help)");
    const std::string& word = arguments.front();
    if (word == "-h" || word == "--help" || word == "--version") return;
    std::vector<std::string> names;
    for (const DeclaredCommand& c : commands)
        names.push_back(c.name);
    if (std::ranges::count(names, word) > 0) return;
    if (word.starts_with("-"))
        throw UsageError(fmt::format("{} comes before the command: expected stromboli COMMAND "
                                     "OPTIONS, as stromboli render SCENE.dae -o out.png",
                                     word));
    constexpr std::string_view kScenes[] = {".dae", ".zae",  ".gltf", ".glb",
                                            ".xml", ".pbrt", ".obj",  ".ply"};
    if (std::ranges::any_of(kScenes, [&](std::string_view e) { return word.ends_with(e); }) ||
        word.starts_with("generate:"))
        throw UsageError(fmt::format(
            "'{0}' is a scene, no command: did you mean stromboli render {0} -o out.png?", word));
    throw UsageError(
        fmt::format("there is no command '{}'{} (see --help)", word, didYouMean(word, names)));
}

/// "-l,--light-samples" has -l and --light-samples.
std::vector<std::string> namesOf(const DeclaredCommand& c) {
    std::vector<std::string> names = {"--help"};
    for (const CommandOption& o : c.list.all()) {
        const Words dashed = o.dashedNames();
        if (!o.isHidden) names.insert(names.end(), dashed.begin(), dashed.end());
    }
    return names;
}

/// Throws the UsageError that says more of a word that no option has: what is like it, and which
/// other commands have it.
void explainUnknown(const std::deque<DeclaredCommand>& commands, const DeclaredCommand& c,
                    const Words& words) {
    const auto known = [](const DeclaredCommand& one, const std::string& name) {
        const std::vector<std::string> names = namesOf(one);
        return std::ranges::count(names, name) > 0;
    };
    for (const std::string& word : words) {
        const std::string name = word.substr(0, word.find('='));
        if (!name.starts_with("-") || known(c, name)) continue;
        std::string others;
        for (const DeclaredCommand& one : commands)
            if (known(one, name)) others += (others.empty() ? "" : ", ") + one.name;
        throw UsageError(fmt::format("{} has no option {}{} (see stromboli {} --help)", c.name,
                                     name,
                                     others.empty() ? didYouMean(name, namesOf(c))
                                                    : fmt::format("; it is one of {}", others),
                                     c.name));
    }
}

/// Throws the UsageError that a flag was given a value, if one was.
void explainFlagValue(const DeclaredCommand& c, const Words& words) {
    for (const CommandOption& o : c.list.all())
        for (const std::string& word : words)
            if (o.wordCount == 0 && word.starts_with(o.name() + "="))
                throw UsageError(fmt::format("{} takes no value: {}", o.name(), word));
}

} // namespace

std::string DeclaredCommand::givenOf(const std::vector<std::string>& names) const {
    std::string text;
    for (const std::string& option : names)
        if (has(option)) text += (text.empty() ? "" : ", ") + option;
    return text;
}

DeclaredCommand* parseCommand(std::deque<DeclaredCommand>& commands, const Words& asTyped) {
    const Words asked = withoutHelpCommand(asTyped);
    CLI::App app(fmt::format("Stromboli: {}.\n{}", kInOneLine, kWhatItDoes), "stromboli");
    app.set_version_flag("--version", std::string("stromboli ") + version());
    app.require_subcommand(1);
    std::string examples;
    for (const Explained& command : kFirstCommands)
        examples += fmt::format("  stromboli {:<39} {}\n", command.word, command.meaning);
    app.footer(
        fmt::format("Examples:\n{}\n'stromboli help COMMAND' explains a command. Exit codes: "
                    "{}. {}",
                    examples, exitCodesInOneLine(), kHowNumbersAreWritten));
    checkCommandName(commands, asked);
    const auto named = std::ranges::find(commands, asked.front(), &DeclaredCommand::name);
    const Words words = named == commands.end() ? asked : inUsualSpelling(named->list, asked);
    Given given;
    std::vector<CLI::App*> apps;
    for (const DeclaredCommand& c : commands) {
        CLI::App* one = apps.emplace_back(app.add_subcommand(c.name, c.description));
        one->group(c.group);
        if (!c.footer.empty()) one->footer(c.footer);
        for (const bool common : {true, false}) // in the order of --help
            for (const CommandOption& o : c.list.all())
                if (o.isCommon == common) declare(*one, o, given);
    }
    try {
        app.parse(Words(words.rbegin(), words.rend())); // CLI11 takes them from the back
    } catch (const CLI::Success& done) {                // --help, --version
        app.exit(done);
        return nullptr;
    } catch (const CLI::ExtrasError& error) {
        for (size_t i = 0; i < apps.size(); ++i)
            if (apps[i]->parsed()) explainUnknown(commands, commands[i], apps[i]->remaining());
        throw UsageError(std::string(error.what()) + " (see --help)");
    } catch (const CLI::ParseError& error) {
        for (size_t i = 0; i < apps.size(); ++i)
            if (commands[i].name == words.front()) explainFlagValue(commands[i], words);
        // Words too many behind an option are taken for others: these stand behind two of it.
        const std::string text = error.what();
        const size_t tooMany = text.find(": At Most ");
        if (tooMany == std::string::npos) throw UsageError(text + " (see --help)");
        throw UsageError(text.substr(0, tooMany) + " is given more than once (see --help)");
    }
    const auto chosen =
        std::find_if(apps.begin(), apps.end(), [](const CLI::App* one) { return one->parsed(); });
    DeclaredCommand& command = commands[size_t(chosen - apps.begin())];
    addImplied(command.list, given);
    command.host.presetSets = addPreset(command.list, given);
    for (const auto& option : given)
        command.given.insert(option.first);
    store(command.list, given);
    command.pictureCommand = pictureCommandOf(command, given);
    return &command;
}

std::optional<ParsedCommand> parseOptions(std::vector<std::string> arguments) {
    std::deque<DeclaredCommand> commands = declareCommands();
    DeclaredCommand* const chosen = parseCommand(commands, fromCs184Spelling(std::move(arguments)));
    if (!chosen) return std::nullopt;
    CommandOptions options = chosen->finish(); // adds remarks
    return ParsedCommand{chosen->host, std::move(options)};
}

} // namespace stromboli
