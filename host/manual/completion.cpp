#include "host/manual/manual.hpp"

#include "scene/find_scene.hpp"
#include "scene/generate/generated_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

namespace stromboli {

// --- Words to propose ----------------------------------------------------------------------------

Words proposalsOf(const CommandOption& o) {
    Words words = o.proposals;
    if (o.proposed != Proposed::Scenes) return words;
    const Words bundled = librarySceneNames();
    words.insert(words.end(), bundled.begin(), bundled.end());
    for (const std::string_view made : kGeneratedScenes)
        words.push_back(fmt::format("{}{}", kGeneratePrefix, made));
    return words;
}

// --- bash ----------------------------------------------------------------------------------------

namespace {

/// Sets, for option $2 of command $1, or for its operand number $2: how many words it takes, words
/// to propose, files or folders to propose, whether it is a list with commas.
constexpr const char* kTableBegins = R"bash(# What an option takes; an operand goes by its number.
_stromboli_takes() {
    count=0 proposals= files= commas=
    case "$1 $2" in
)bash";

constexpr const char* kTableEnds = R"bash(    esac
}

)bash";

/// Bash takes = and : for ends of words. Where bash-completion is installed it puts such words
/// together again; without it only those are completed that have neither.
constexpr const char* kWalk = R"bash(# Completes the word under the cursor.
_stromboli() {
    local cur words cword
    if declare -F _get_comp_words_by_ref >/dev/null; then
        _get_comp_words_by_ref -n := cur words cword
    else
        cur=${COMP_WORDS[COMP_CWORD]} words=("${COMP_WORDS[@]}") cword=$COMP_CWORD
    fi
    COMPREPLY=()
    if ((cword == 1)); then
        mapfile -t COMPREPLY < <(compgen -W "$_stromboli_commands -h --help --version" -- "$cur")
        return
    fi

    # What stands before the cursor: operands, and options with the words that they take.
    local command=${words[1]} count proposals files commas
    local word operands=0 i=2 inside=
    while ((i < cword)); do
        word=${words[i]}
        if [[ $word == -* ]]; then
            _stromboli_takes "$command" "$word"
            if ((i + count >= cword)); then
                inside=1
                break
            fi
            ((i += count))
        else
            ((operands += 1))
        fi
        ((i += 1))
    done

    local options=
    if [[ $inside ]]; then
        : # a word of the option that _stromboli_takes was asked about last
    elif [[ $cur == --*=* ]]; then # readline replaces what is behind the =
        _stromboli_takes "$command" "${cur%%=*}"
        cur=${cur#*=}
    elif [[ $cur == -* ]]; then
        options=1
    else
        _stromboli_takes "$command" "$((operands + 1))"
        ((count > 0)) || options=1
    fi
    if [[ $options ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_stromboli_options "$command")" -- "$cur")
        return
    fi

    local before=
    if [[ $commas && $cur == *,* ]]; then
        before=${cur%,*},
    fi
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$proposals" -- "${cur#"$before"}")
    if [[ $files ]]; then
        compopt -o filenames 2>/dev/null # not there outside of a completion
        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -A "$files" -- "$cur")
    fi
    if declare -F __ltrim_colon_completions >/dev/null; then
        __ltrim_colon_completions "$cur"
    fi
}

complete -F _stromboli stromboli
)bash";

/// The names of all options that are listed.
Words optionNames(const DeclaredCommand& c) {
    Words names = {"-h", "--help"};
    for (const CommandOption& o : c.list.all()) {
        const Words dashed = o.dashedNames();
        if (!o.isHidden) names.insert(names.end(), dashed.begin(), dashed.end());
    }
    return names;
}

/// A line of the table, for the words of `command` that `pattern` says.
std::string rowOf(const std::string& pattern, const CommandOption& o) {
    const Words proposals = proposalsOf(o);
    std::string row = fmt::format("    {}) count={}", pattern, o.wordCount);
    if (!proposals.empty()) row += fmt::format(" proposals='{}'", fmt::join(proposals, " "));
    if (o.proposed == Proposed::Folders) row += " files=directory";
    if (o.proposed == Proposed::Files || o.proposed == Proposed::Scenes) row += " files=file";
    if (o.separatedByCommas) row += " commas=1";
    return row + " ;;\n";
}

/// "'render -o' | 'render --output'", or of the second operand "'compare 2'".
std::string patternOf(const DeclaredCommand& c, const CommandOption& o, int operand) {
    const Words dashed = o.dashedNames();
    if (dashed.empty())
        return o.anyNumber ? fmt::format("'{} '[0-9]*", c.name)
                           : fmt::format("'{} {}'", c.name, operand);
    std::string pattern;
    for (const std::string& name : dashed)
        pattern += fmt::format("{}'{} {}'", pattern.empty() ? "" : " | ", c.name, name);
    return pattern;
}

std::string rowsOf(const DeclaredCommand& c) {
    std::string rows;
    int operand = 0;
    for (const CommandOption& o : c.list.all()) {
        if (o.dashedNames().empty()) ++operand;
        if (o.wordCount > 0) rows += rowOf(patternOf(c, o, operand), o);
    }
    return rows;
}

} // namespace

std::string bashCompletion() {
    const std::deque<DeclaredCommand> commands = declareCommands();
    Words names;
    std::string options, table;
    for (const DeclaredCommand& c : commands) {
        names.push_back(c.name);
        options += fmt::format("    {}) echo '{}' ;;\n", c.name, fmt::join(optionNames(c), " "));
        table += rowsOf(c);
    }
    return fmt::format("# Completion of stromboli's commands and options for bash.\n\n"
                       "_stromboli_commands='{}'\n\n"
                       "_stromboli_options() {{\n    case $1 in\n{}    esac\n}}\n\n",
                       fmt::join(names, " "), options) +
           kTableBegins + table + kTableEnds + kWalk;
}

// --- fish ----------------------------------------------------------------------------------------

namespace {

std::string quoted(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return "'" + safe + "'";
}

/// The names of an option as fish takes them: " -s r -l size".
std::string namesFor(const CommandOption& o) {
    std::string names;
    for (const std::string& name : o.dashedNames())
        names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    return names;
}

/// What it takes, and where that comes from. Of several words fish knows the first.
std::string takes(const CommandOption& o) {
    if (o.wordCount == 0) return "";
    const bool files = o.proposed == Proposed::Files || o.proposed == Proposed::Scenes;
    std::string text = o.dashedNames().empty() ? "" : " -r";
    text += files ? " -F" : " -f";
    if (o.proposed == Proposed::Folders) text += " -a '(__fish_complete_directories)'";
    const Words proposals = proposalsOf(o);
    if (!proposals.empty()) text += fmt::format(" -a '{}'", fmt::join(proposals, " "));
    return text;
}

std::string linesOf(const DeclaredCommand& c) {
    const std::string inside =
        fmt::format("complete -c stromboli -n '__fish_seen_subcommand_from {}'", c.name);
    std::string lines =
        fmt::format("\ncomplete -c stromboli -n __fish_use_subcommand -a {} -d {}\n", c.name,
                    quoted(c.description));
    for (const CommandOption& o : c.list.all()) {
        if (o.isHidden) continue;
        const bool isOperand = o.dashedNames().empty();
        lines += inside + namesFor(o) + takes(o) +
                 (isOperand ? "" : " -d " + quoted(o.fullHelp())) + "\n";
    }
    return lines;
}

} // namespace

std::string fishCompletion() {
    std::string text =
        "# Completion of stromboli's commands and options for fish.\n\n"
        "complete -c stromboli -f\n"
        "complete -c stromboli -s h -l help -d 'lists commands or options'\n"
        "complete -c stromboli -n __fish_use_subcommand -l version -d 'of the program'\n";
    const std::deque<DeclaredCommand> commands = declareCommands();
    for (const DeclaredCommand& c : commands)
        text += linesOf(c);
    return text;
}

// --- zsh -----------------------------------------------------------------------------------------

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
