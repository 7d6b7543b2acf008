#include "tests/cli/program.hpp"
#include "source_dir.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace stromboli::test {
namespace {

std::string quoted(const std::string& s) {
    std::string result = "'";
    for (char c : s)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

std::string read(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

} // namespace

ProgramRun stromboli(const std::vector<std::string>& arguments, const std::string& environment,
                     const std::string& redirection) {
    const ScratchFolder outputs;
    std::string command = "STROMBOLI_VALIDATION=1 " + environment + " " + STROMBOLI_PROGRAM;
    for (const std::string& a : arguments)
        command += " " + quoted(a);
    command +=
        " >" + outputs.file("out") + " 2>" + outputs.file("err") + " </dev/null " + redirection;
    const int status = std::system(command.c_str());
    ProgramRun run;
    run.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    run.out = read(outputs.path() / "out");
    run.err = read(outputs.path() / "err");
    return run;
}

ScratchFolder::ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "stromboli-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no scratch folder");
    path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
}

std::string ScratchFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return file(name);
}

std::vector<std::string> ScratchFolder::entries() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string bytesOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string libraryScene(const std::string& name) {
    return (std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library" / name).string();
}

} // namespace stromboli::test
