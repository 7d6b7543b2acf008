#include "host/cli/command_line.hpp"

#include <fstream>

namespace stromboli {

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

} // namespace stromboli
