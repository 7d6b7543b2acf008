#include "host/cli/program_text.hpp"

#include "host/version/version.hpp"

#include <fmt/format.h>

namespace stromboli {

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
           "Other commands: merge, submit, devices, compare, study, bench, stress. 'stromboli "
           "--help'\n"
           "says what each does, 'stromboli COMMAND --help' lists its options.\n";
}

} // namespace stromboli
