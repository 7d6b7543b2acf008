#include "host/manual/fish_completion.hpp"

#include "host/cli/declared_command.hpp"
#include "host/manual/proposals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stromboli {
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

} // namespace stromboli
