#include "host/manual/manual.hpp"

#include "host/cli/command_line.hpp"
#include "host/version/version.hpp"
#include "scene/find_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <sstream>

namespace stromboli {
namespace {

/// What the program and its libraries heed.
constexpr std::array kEnvironment = {
    Explained{"STROMBOLI_CACHE_DIR",
              "folder for compiled kernels, instead of stromboli in the user's cache folder; "
              "empty: nothing is kept"},
    Explained{"STROMBOLI_VALIDATION",
              "1: the Vulkan validation layer is on, and any message of it fails the run"},
    Explained{"XDG_CACHE_HOME, HOME", "where the user's cache folder is"},
    Explained{"NO_COLOR", "not empty: messages have no colours"},
    Explained{"TERM", "dumb: no status line is drawn"},
    Explained{"LP_NUM_THREADS", "threads of Mesa's lavapipe, the device that is a CPU"},
    Explained{"LP_NATIVE_VECTOR_WIDTH", "bits of lavapipe's vectors; with Mesa 22.3 512 where the "
                                        "processor has AVX-512, unless this says "
                                        "256"},
};

/// Text in which roff finds nothing to obey: no requests, no escapes, and no characters that it
/// would set in a nicer way.
std::string plain(const std::string& text) {
    std::string safe;
    bool atStart = true;
    for (const char c : text) {
        if (atStart && (c == '.' || c == '\'')) safe += "\\&";
        switch (c) {
        case '\\':
            safe += "\\e";
            break;
        case '-':
            safe += "\\-";
            break;
        case '\'':
            safe += "\\(aq";
            break;
        case '`':
            safe += "\\(ga";
            break;
        case '^':
            safe += "\\(ha";
            break;
        case '~':
            safe += "\\(ti";
            break;
        case '"':
            safe += "\\(dq";
            break;
        default:
            safe += c;
        }
        atStart = c == '\n';
    }
    return safe;
}

std::string bold(const std::string& text) {
    return "\\fB" + plain(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + plain(text) + "\\fR";
}

std::string section(const std::string& title) {
    return fmt::format(".SH {}\n", title);
}

/// A term and what it means, indented below it.
std::string item(const std::string& term, const std::string& meaning) {
    return fmt::format(".TP\n{}\n{}\n", term, plain(meaning));
}

template <class List>
std::string items(const List& list) {
    std::string text;
    for (const Explained& one : list)
        text += item(bold(one.word), one.meaning);
    return text;
}

/// "-r, --size W H" or "SCENE".
std::string termOf(const CommandOption& o) {
    const Words names = o.dashedNames();
    if (names.empty()) return italic(o.name()) + (o.anyNumber ? "..." : "");
    std::string term;
    for (const std::string& name : names)
        term += (term.empty() ? "" : ", ") + bold(name);
    return o.valueNames.empty() ? term : term + " " + italic(o.valueNames);
}

/// "stromboli render SCENE [OPTION...]".
std::string usageOf(const DeclaredCommand& c) {
    std::string usage = bold("stromboli " + c.name);
    for (const CommandOption& o : c.list.all()) {
        if (!o.dashedNames().empty()) continue;
        const std::string term = termOf(o);
        usage += " " + (o.isRequired ? term : "[" + term + "]");
    }
    return usage + " [" + italic("OPTION") + "...]";
}

std::vector<std::string> groupsOf(const DeclaredCommand& c) {
    std::vector<std::string> groups;
    for (const CommandOption& o : c.list.all())
        if (!o.isHidden && std::find(groups.begin(), groups.end(), o.group) == groups.end())
            groups.push_back(o.group);
    return groups;
}

std::string pageOf(const DeclaredCommand& c) {
    std::string text = fmt::format(".SS {}\n{}.\n", plain(c.name), plain(c.description));
    text += fmt::format(".PP\n{}\n", usageOf(c));
    for (const std::string& group : groupsOf(c)) {
        text += fmt::format(".PP\n{}\n", italic(group + ":"));
        for (const CommandOption& o : c.list.all())
            if (!o.isHidden && o.group == group) text += item(termOf(o), o.fullHelp());
    }
    if (!c.footer.empty()) {
        std::istringstream lines(c.footer);
        for (std::string line; std::getline(lines, line);)
            text += fmt::format(".PP\n{}\n", plain(line));
    }
    return text;
}

std::string scenes() {
    return section("SCENES") +
           plain("A scene is a COLLADA file (.dae, or an archive .zae), a glTF file (.gltf, .glb), "
                 "a Wavefront OBJ file (.obj) or a PLY file (.ply), one of the bundled scenes, "
                 "or one that is made in memory, as generate:cornell_mesh:100k. The bundled scenes "
                 "go by these names everywhere:\n") +
           fmt::format("{}.\n", plain(fmt::format("{}", fmt::join(librarySceneNames(), ", "))));
}

std::string examples() {
    std::string text = section("EXAMPLES");
    for (const Explained& command : kFirstCommands)
        text += item(bold(fmt::format("stromboli {}", command.word)), command.meaning);
    return text;
}

} // namespace

std::string manPage() {
    const std::deque<DeclaredCommand> commands = declareCommands();
    std::string text =
        fmt::format(".TH STROMBOLI 1 \"\" \"stromboli {}\" \"User Commands\"\n", version());
    text += ".nh\n.ad l\n"; // words such as generate:lamps:N stay whole
    text += section("NAME") + fmt::format("stromboli \\- {}\n", plain(kInOneLine));
    text += section("SYNOPSIS");
    for (const DeclaredCommand& c : commands)
        text += usageOf(c) + "\n.br\n";
    text += bold("stromboli --help") + " | " + bold("--version") + "\n";
    text += section("DESCRIPTION") + plain(kWhatItDoes) + "\n";
    text += plain(kHowNumbersAreWritten) + "\n";
    text += "Ranges and, in brackets, defaults stand behind each option.\n";
    text +=
        section("COMMANDS") + "Each command also has " + bold("-h") + ", " + bold("--help") + ".\n";
    for (const DeclaredCommand& c : commands)
        text += pageOf(c);
    text += scenes();
    text +=
        section("EXIT STATUS") + items(kExitCodes) +
        item("128 + " + italic("n"),
             "ended by signal n; a render that had begun to take samples wrote the picture so far");
    text += section("ENVIRONMENT") + items(kEnvironment);
    text += examples();
    text += section("SEE ALSO") +
            plain("README.md and the folder docs in share/doc/stromboli: how to read the output, "
                  "what is estimated, what is measured.\n");
    return text;
}

} // namespace stromboli
