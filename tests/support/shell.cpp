#include "tests/support/shell.hpp"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace stromboli::test {

ShellRun shell(const std::string& commands) {
    const EmptyFolder folder;
    std::ofstream(folder / "script") << commands;
    const std::string line =
        "bash " + (folder / "script") + " >" + (folder / "output") + " 2>&1 </dev/null";
    const int status = std::system(line.c_str());
    ShellRun run;
    run.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    std::ostringstream text;
    text << std::ifstream(folder / "output").rdbuf();
    run.output = text.str();
    return run;
}

bool isInstalled(const std::string& program) {
    return shell("command -v " + program).exitCode == 0;
}

EmptyFolder::EmptyFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "stromboli-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no scratch folder");
    path_ = pattern;
}

EmptyFolder::~EmptyFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

} // namespace stromboli::test
