#include "scene/build/read_file.hpp"

#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"
#include "host/core/system.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace stromboli::build {
namespace {

/// Open for reading; closed at the end.
class Descriptor {
  public:
    /// Without O_NONBLOCK, opening a named pipe would wait for somebody to write to it.
    explicit Descriptor(const std::filesystem::path& file)
        : number_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }

  private:
    int number_;
};

const char* kindOf(mode_t mode) {
    if (S_ISDIR(mode)) return "a directory";
    if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
    if (S_ISFIFO(mode)) return "a pipe";
    return "no regular file";
}

/// What stands under a file's name where the file itself has not been fetched; null if nothing says
/// so.
const char* standInFor(std::string_view bytes) {
    if (bytes.starts_with("version https://git-lfs.github.com/spec/"))
        return "is a pointer of Git LFS and not the file, which 'git lfs pull' fetches";
    std::string first(bytes.substr(0, 64));
    std::ranges::transform(first, first.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    first.erase(0, first.find_first_not_of(" \t\r\n"));
    if (first.starts_with("<!doctype html") || first.starts_with("<html"))
        return "is a web page (HTML) and not the file, as where a download has failed";
    return nullptr;
}

} // namespace

void requireMemory(const std::string& file, uint64_t bytes) {
    const uint64_t memory = physicalMemory();
    if (bytes > memory)
        throw SceneError(
            file, 0, "",
            fmt::format("needs {} MiB of memory, more than the {} MiB this machine has",
                        bytes >> 20, memory >> 20));
}

std::string readFile(const std::filesystem::path& file, size_t most) {
    const auto fail = [&](const std::string& message) {
        throw SceneError(file.string(), 0, "", message);
    };
    const auto failBecause = [&](const char* what) {
        fail(fmt::format("cannot be {}: {}", what, std::strerror(errno)));
    };
    const Descriptor in(file);
    if (in.number() < 0) {
        const std::string reason = std::strerror(errno);
        fail(fmt::format("cannot be opened for reading: {}{}", reason, didYouMeanFile(file)));
    }
    struct stat status {};
    if (fstat(in.number(), &status) != 0) failBecause("looked at");
    if (!S_ISREG(status.st_mode))
        fail(fmt::format("is {}, expected a scene file", kindOf(status.st_mode)));
    requireMemory(file.string(), uint64_t(status.st_size));

    // What the file has at this moment and no more, so that one without an end has one. Those of
    // /proc state no size; none of them is a scene.
    std::string bytes(std::min(most, size_t(status.st_size)), '\0');
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = read(in.number(), bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) failBecause("read to its end");
        if (got == 0) break; // it has been cut in the meantime
        done += size_t(got);
    }
    bytes.resize(done);
    if (const char* problem = standInFor(bytes)) fail(problem);
    return bytes;
}

} // namespace stromboli::build
