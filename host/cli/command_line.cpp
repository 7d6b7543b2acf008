#include "host/cli/command_line.hpp"

#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
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
           "SCENE is a COLLADA, glTF, OBJ or PLY file (.dae, .gltf, .glb, .obj, .ply), a bundled "
           "scene\n"
           "by its name, as cornell_mesh, or generate:cornell_mesh:100k, which is made in memory.\n"
           "\n"
           "Other commands: tonemap, merge, submit, devices, compare, study, bench, stress.\n"
           "'stromboli --help' says what each does, 'stromboli COMMAND --help' lists its "
           "options.\n";
}

// --- Words of command lines ----------------------------------------------------------------------

namespace {

bool isWholeNumber(const std::string& s) {
    return !s.empty() &&
           std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::optional<std::string> onlyOneThatBegins(const std::string& word,
                                             const std::vector<std::string>& names) {
    std::optional<std::string> found;
    for (const std::string& name : names) {
        if (!name.starts_with(word)) continue;
        if (found) return std::nullopt;
        found = name;
    }
    return found;
}

} // namespace

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

std::vector<std::string> fromCs184Spelling(std::vector<std::string> arguments) {
    for (size_t i = 0; i < arguments.size(); ++i) {
        std::string& a = arguments[i];
        const bool numberFollows = i + 1 < arguments.size() && isWholeNumber(arguments[i + 1]);
        if (a == "-f")
            a = "-o";
        else if (a == "-o" && numberFollows)
            a = "--accumulate";
        else if (a == "-p")
            a = "--cell";
    }
    return arguments;
}

size_t editDistance(const std::string& a, const std::string& b) {
    // d[i][j]: between the first i letters of a and the first j of b.
    std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); ++i)
        for (size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            const size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

std::optional<std::string> nearestName(const std::string& word,
                                       const std::vector<std::string>& names) {
    if (word.empty() || names.empty()) return std::nullopt;
    if (const auto begun = onlyOneThatBegins(word, names)) return begun;
    const auto nearest = std::ranges::min_element(
        names, {}, [&](const std::string& name) { return editDistance(word, name); });
    if (3 * editDistance(word, *nearest) > std::max(word.size(), nearest->size()))
        return std::nullopt;
    return *nearest;
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

void declare(CLI::App& app, const CommandOption& o, Given& given) {
    if (o.wordCount == 0) {
        app.add_flag_function(
               o.names, [&given, name = o.name()](std::int64_t) { given[name] = {}; }, o.help)
            ->group(o.isHidden ? "" : o.group)
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
    option->group(o.isHidden ? "" : o.group);
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

std::string perhaps(const std::string& word, const std::vector<std::string>& names) {
    const std::optional<std::string> nearest = nearestName(word, names);
    return nearest ? fmt::format("; did you mean {}?", *nearest) : "";
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
    if (word.ends_with(".dae") || word.ends_with(".gltf") || word.ends_with(".glb") ||
        word.ends_with(".obj") || word.ends_with(".ply") || word.starts_with("generate:"))
        throw UsageError(fmt::format(
            "'{0}' is a scene, no command: did you mean stromboli render {0} -o out.png?", word));
    throw UsageError(
        fmt::format("there is no command '{}'{} (see --help)", word, perhaps(word, names)));
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
        throw UsageError(fmt::format(
            "{} has no option {}{} (see stromboli {} --help)", c.name, name,
            others.empty() ? perhaps(name, namesOf(c)) : fmt::format("; it is one of {}", others),
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

DeclaredCommand* parseCommand(std::deque<DeclaredCommand>& commands, const Words& words) {
    CLI::App app(fmt::format("Stromboli: {}.\n{}", kInOneLine, kWhatItDoes), "stromboli");
    app.set_version_flag("--version", std::string("stromboli ") + version());
    app.require_subcommand(1);
    app.footer(fmt::format("'stromboli COMMAND --help' explains a command. Exit codes: {}. {}",
                           exitCodesInOneLine(), kHowNumbersAreWritten));
    checkCommandName(commands, words);
    Given given;
    std::vector<CLI::App*> apps;
    for (const DeclaredCommand& c : commands) {
        CLI::App* one = apps.emplace_back(app.add_subcommand(c.name, c.description));
        if (!c.footer.empty()) one->footer(c.footer);
        for (const CommandOption& o : c.list.all())
            declare(*one, o, given);
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
        throw UsageError(std::string(error.what()) + " (see --help)");
    }
    const auto chosen =
        std::find_if(apps.begin(), apps.end(), [](const CLI::App* one) { return one->parsed(); });
    DeclaredCommand& command = commands[size_t(chosen - apps.begin())];
    addImplied(command.list, given);
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
