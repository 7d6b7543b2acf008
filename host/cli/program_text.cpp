#include "host/cli/program_text.hpp"

namespace stromboli {

std::string exitCodesInOneLine() {
    std::string text;
    for (const Explained& code : kExitCodes)
        text += std::string(text.empty() ? "" : ", ") + code.word + " " + code.meaning;
    return text;
}

} // namespace stromboli
