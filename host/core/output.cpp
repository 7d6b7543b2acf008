#include "host/core/output.hpp"

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace stromboli {

namespace fs = std::filesystem;

[[noreturn]] static void failToPrint(const std::string& reason) {
    throw OutputError("standard output: cannot write: " + reason);
}

bool isStandardOutput(const fs::path& path) {
    return path == "-";
}

void writeOutput(const fs::path& path, std::span<const std::byte> bytes) {
    if (!isStandardOutput(path)) return writeFileAtomically(path, bytes);
    finishStandardOutput();
    while (!bytes.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) failToPrint(std::generic_category().message(errno));
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
}

void writeOutput(const fs::path& path, std::string_view text) {
    writeOutput(path, std::as_bytes(std::span(text)));
}

void checkOutputWritable(const fs::path& path) {
    if (!isStandardOutput(path)) checkFileWritable(path);
}

void reserveStandardStreams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) >= 0) continue;
        // open() takes the smallest free number. Reading from an output is allowed to nobody.
        const int mode = descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY;
        if (::open("/dev/null", mode) < 0) return;
    }
}

void finishStandardOutput() {
    const bool failedBefore = std::ferror(stdout) != 0;
    if (std::fflush(stdout) != 0) failToPrint(std::generic_category().message(errno));
    if (failedBefore) failToPrint("not all of it was taken");
}

} // namespace stromboli
