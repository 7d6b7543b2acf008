#include "host/cli/command_line.hpp"

#include <fstream>

namespace stromboli {

std::string commandLine() {
    std::ifstream file("/proc/self/cmdline");
    std::string text;
    for (std::string argument; std::getline(file, argument, '\0');)
        text += (text.empty() ? "" : " ") + argument;
    return text;
}

} // namespace stromboli
