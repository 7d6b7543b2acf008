// stromboli_write_manual man|bash|fish|zsh: the manual page, or completion, on standard output.
#include "host/manual/manual.hpp"

#include <cstdio>
#include <string>

namespace {

/// Empty: there is no such text.
std::string written(const std::string& kind) {
    if (kind == "man") return stromboli::manPage();
    if (kind == "bash") return stromboli::bashCompletion();
    if (kind == "fish") return stromboli::fishCompletion();
    if (kind == "zsh") return stromboli::zshCompletion();
    return {};
}

} // namespace

int main(int argc, char** argv) {
    const std::string text = written(argc == 2 ? argv[1] : "");
    if (text.empty()) {
        std::fputs("expected: stromboli_write_manual man|bash|fish|zsh\n", stderr);
        return 1;
    }
    std::fputs(text.c_str(), stdout);
    return std::fflush(stdout) == 0 ? 0 : 4;
}
