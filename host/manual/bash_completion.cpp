#include "host/manual/bash_completion.hpp"

#include "host/cli/declared_command.hpp"
#include "host/manual/proposals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stromboli {
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

/// Of all options that are listed.
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

} // namespace stromboli
