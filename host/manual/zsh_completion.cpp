#include "host/manual/zsh_completion.hpp"

#include "host/cli/declared_command.hpp"
#include "host/manual/proposals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

namespace stromboli {
namespace {

/// Calls zsh's own _arguments, which counts the words of options and operands. The first word is
/// the command from there on.
constexpr const char* kBegins = R"zsh(_stromboli() {
    if ((CURRENT == 2)); then
        _stromboli_commands
        return
    fi
    shift words
    ((CURRENT -= 1))
    case $words[1] in
)zsh";

constexpr const char* kEnds = R"zsh(    esac
}

# Loaded by compinit it is called as a function at once.
if [[ $funcstack[1] == _stromboli ]]; then
    _stromboli "$@"
else
    compdef _stromboli stromboli
fi
)zsh";

std::string inQuotes(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return "'" + safe + "'";
}

/// Text in which _arguments and _describe find none of `special`.
std::string plain(const std::string& text, const std::string& special) {
    std::string safe;
    for (const char c : text)
        safe += special.find(c) == std::string::npos ? std::string(1, c) : std::string("\\") + c;
    return safe;
}

/// What to do for a word: nothing, propose words, files, or both.
std::string actionOf(const CommandOption& o) {
    const bool files = o.proposed == Proposed::Files || o.proposed == Proposed::Scenes;
    const Words proposals = proposalsOf(o);
    const std::string words =
        proposals.empty() ? "" : fmt::format("compadd -- {}", fmt::join(proposals, " "));
    if (o.separatedByCommas && !proposals.empty())
        return fmt::format("{{_values -s , words {}}}", fmt::join(proposals, " "));
    if (o.proposed == Proposed::Folders) return "_files -/";
    if (!files) return words.empty() ? " " : "{" + words + "}";
    return words.empty() ? "_files" : "{" + words + "; _files}";
}

/// ":W:ACTION:H:ACTION" for the words W and H.
std::string wordsOf(const CommandOption& o) {
    std::string text;
    std::istringstream names(o.valueNames);
    for (uint32_t i = 0; i < o.wordCount; ++i) {
        std::string name;
        names >> name;
        text += ":" + plain(name, ":\\") + ":" + plain(actionOf(o), ":\\");
    }
    return text;
}

/// The arguments of _arguments for an option: one for each of its names, which exclude each other.
std::string specsOf(const CommandOption& o) {
    const Words dashed = o.dashedNames();
    if (dashed.empty())
        return " " + inQuotes((o.anyNumber ? "*:" : ":") + plain(o.name(), ":\\") + ":" +
                              plain(actionOf(o), ":\\"));
    std::string specs;
    for (const std::string& name : dashed) {
        const std::string once = o.mayRepeat ? "*" : fmt::format("({})", fmt::join(dashed, " "));
        specs += " " + inQuotes(fmt::format("{}{}{}[{}]{}", once, name,
                                            o.wordCount == 1 && name.starts_with("--") ? "=" : "",
                                            plain(o.fullHelp(), "[]\\"), wordsOf(o)));
    }
    return specs;
}

} // namespace

std::string zshCompletion() {
    const std::deque<DeclaredCommand> commands = declareCommands();
    std::string names, cases;
    for (const DeclaredCommand& c : commands) {
        names += " " + inQuotes(plain(c.name, ":\\") + ":" + plain(c.description, ":\\"));
        cases += fmt::format("    {}) _arguments", c.name);
        for (const CommandOption& o : c.list.all())
            if (!o.isHidden) cases += " \\\n        " + specsOf(o).substr(1);
        cases += " \\\n        '(- *)'{-h,--help}'[lists the options]' ;;\n";
    }
    return "#compdef stromboli\n"
           "# Completion of stromboli's commands and options for zsh.\n\n"
           "_stromboli_commands() {\n"
           "    local -a commands=(" +
           names +
           ")\n    _describe command commands\n"
           "    compadd -- -h --help --version\n}\n\n" +
           kBegins + cases + kEnds;
}

} // namespace stromboli
