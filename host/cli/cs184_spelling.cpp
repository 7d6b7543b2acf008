#include "host/cli/cs184_spelling.hpp"

#include <algorithm>
#include <cctype>

namespace stromboli {

static bool isWholeNumber(const std::string& s) {
    return !s.empty() &&
           std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
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

} // namespace stromboli
