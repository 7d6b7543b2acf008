#include "host/bench/child_process.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace stromboli::bench {
namespace {

std::vector<std::string> environmentWith(const Environment& changes) {
    std::vector<std::string> all;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        const std::string name = text.substr(0, text.find('='));
        const bool changed = std::any_of(changes.begin(), changes.end(),
                                         [&](const auto& c) { return c.first == name; });
        if (!changed) all.push_back(text);
    }
    for (const auto& [name, value] : changes)
        all.push_back(name + "=" + value);
    return all;
}

/// As exec wants them: pointers, the last one null. The strings must stay.
std::vector<char*> pointers(std::vector<std::string>& strings) {
    std::vector<char*> result;
    for (std::string& s : strings)
        result.push_back(s.data());
    result.push_back(nullptr);
    return result;
}

/// Where the three standard streams of a child go.
class Streams {
  public:
    Streams(const std::string& out, const std::string& err) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, out.c_str(), flags, 0600);
        posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, err.c_str(), flags, 0600);
    }
    ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_;
};

std::string textOf(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

std::string lastLine(const std::string& text) {
    const size_t end = text.find_last_not_of('\n');
    if (end == std::string::npos) return "it said nothing";
    const size_t before = text.rfind('\n', end);
    const size_t begin = before == std::string::npos ? 0 : before + 1;
    return text.substr(begin, end + 1 - begin);
}

} // namespace

ScratchFolder::ScratchFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "stromboli-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw OutputError(fmt::format("cannot make {}: {}", pattern, std::strerror(errno)));
    path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string runProgram(const std::vector<std::string>& command, const Environment& changes) {
    const ScratchFolder folder;
    const std::filesystem::path out = folder.path() / "out", err = folder.path() / "err";
    const Streams streams(out.string(), err.string());
    std::vector<std::string> arguments = command, environment = environmentWith(changes);
    pid_t child = 0;
    const int error = posix_spawn(&child, command[0].c_str(), streams.get(), nullptr,
                                  pointers(arguments).data(), pointers(environment).data());
    if (error != 0)
        throw DeviceError(fmt::format("cannot start {}: {}", command[0], std::strerror(error)));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw DeviceError(
            fmt::format("'{}' failed: {}", fmt::join(command, " "), lastLine(textOf(err))));
    return textOf(out);
}

} // namespace stromboli::bench
