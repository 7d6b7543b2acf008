#include "host/core/files.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <mutex>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace stromboli {

// --- Files that are whole or not there -----------------------------------------------------------

namespace fs = std::filesystem;

/// The file that `path` stands for once symbolic links are followed; it need not exist.
static fs::path followLinks(const fs::path& path) {
    constexpr int kMostLinks = 40; // as the Linux kernel (MAXSYMLINKS)
    fs::path target = path;
    std::error_code error;
    for (int i = 0; fs::is_symlink(target, error); ++i) {
        if (i == kMostLinks) failToWrite(path, ELOOP);
        target = target.parent_path() / fs::read_symlink(target, error);
        if (error) failToWrite(path, error.message());
    }
    return target;
}

static void checkTarget(const fs::path& path) {
    const fs::path folder = folderOf(path);
    std::error_code error;
    const fs::file_status folderStatus = fs::status(folder, error);
    if (folderStatus.type() == fs::file_type::not_found)
        failToWrite(path, fmt::format("the folder {} does not exist", folder.string()));
    if (error) failToWrite(path, error.message());
    if (!fs::is_directory(folderStatus))
        failToWrite(path, fmt::format("{} is not a folder", folder.string()));

    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) failToWrite(path, "it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status))
        failToWrite(path, "it is not a regular file");
    if (fs::exists(status) && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
        failToWrite(path, errno);
}

void writeFileAtomically(const fs::path& path, std::span<const std::byte> bytes, Sync sync) {
    const fs::path target = followLinks(path);
    checkTarget(target);
    TemporaryFile file(target);
    file.write(bytes);
    file.rename(sync);
}

void checkFileWritable(const fs::path& path) {
    const fs::path target = followLinks(path);
    checkTarget(target);
    TemporaryFile file(target);
}

void checkFreeSpace(const fs::path& path, uint64_t bytes) {
    struct statvfs system = {};
    if (::statvfs(folderOf(followLinks(path)).c_str(), &system) != 0) return;
    if (system.f_blocks == 0) return; // a file system that counts no blocks, as some network ones
    const uint64_t free = uint64_t(system.f_bavail) * system.f_frsize;
    if (bytes > free)
        failToWrite(path, fmt::format("it may need {} bytes, but {} are free there", bytes, free));
}

// --- Temporary files -----------------------------------------------------------------------------

namespace {

/// The temporary files there are. Held while one appears, is renamed or disappears, so that the
/// thread that ends the process knows of all.
struct Registry {
    std::mutex mutex;
    std::set<fs::path> files;
};

/// Never destroyed: threads may still write when main has returned.
Registry& registry() {
    static Registry& all = *new Registry;
    return all;
}

std::string prefixFor(const fs::path& path) {
    return fmt::format(".{}.", path.filename().string());
}

/// PID.N.tmp
bool isTemporaryEnding(std::string_view text) {
    constexpr std::string_view kEnding = ".tmp";
    if (!text.ends_with(kEnding)) return false;
    text.remove_suffix(kEnding.size());
    const auto isNumber = [](std::string_view s) {
        return !s.empty() && std::ranges::all_of(s, [](char c) { return c >= '0' && c <= '9'; });
    };
    const size_t dot = text.find('.');
    return dot != std::string_view::npos && isNumber(text.substr(0, dot)) &&
           isNumber(text.substr(dot + 1));
}

/// Whether nobody has it locked. Numbers of processes are no evidence: they are used again, and on
/// a shared disk they are those of another machine.
bool isAbandoned(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return false;
    const bool locked = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0;
    ::close(descriptor);
    return !locked;
}

void removeAbandoned(const fs::path& path) {
    const std::string prefix = prefixFor(path);
    std::error_code error;
    fs::directory_iterator entry(folderOf(path), error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with(prefix) &&
            isTemporaryEnding(std::string_view(name).substr(prefix.size())) &&
            isAbandoned(entry->path()))
            ::unlink(entry->path().c_str());
    }
}

/// Whether the file still has a name: another process may have taken it for abandoned before it was
/// locked.
bool hasName(int descriptor) {
    struct stat status = {};
    return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

} // namespace

void failToWrite(const fs::path& path, const std::string& reason) {
    throw OutputError(fmt::format("{}: cannot write: {}", path.string(), reason));
}

void failToWrite(const fs::path& path, int error) {
    failToWrite(path, std::generic_category().message(error));
}

fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

TemporaryFile::TemporaryFile(const fs::path& path) : path_(path) {
    removeAbandoned(path);
    const std::lock_guard lock(registry().mutex);
    for (int attempt = 0; descriptor_ < 0; ++attempt) {
        temporary_ = folderOf(path) / fmt::format("{}{}.{}.tmp", prefixFor(path),
                                                  static_cast<long>(::getpid()), attempt);
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno == EEXIST) continue; // another thread's
        if (descriptor_ < 0)
            failToWrite(path, fmt::format("no file can be made in the folder {}: {}",
                                          folderOf(path).string(),
                                          std::generic_category().message(errno)));
        ::flock(descriptor_, LOCK_EX | LOCK_NB); // where there are no locks nothing is abandoned
        if (hasName(descriptor_)) continue;
        ::close(descriptor_);
        descriptor_ = -1;
    }
    registry().files.insert(temporary_);
}

TemporaryFile::~TemporaryFile() {
    if (!renamed_) {
        const std::lock_guard lock(registry().mutex);
        ::unlink(temporary_.c_str());
        registry().files.erase(temporary_);
    }
    if (descriptor_ >= 0) ::close(descriptor_);
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) failToWrite(path_, errno);
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
}

/// Some file systems report a full disk only when the data are flushed or the file is closed. The
/// second descriptor keeps the lock until the file has its name.
void TemporaryFile::rename(Sync sync) {
    if (sync == Sync::Now && ::fsync(descriptor_) != 0) failToWrite(path_, errno);
    const int first = std::exchange(descriptor_, ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0));
    if (::close(first) != 0) failToWrite(path_, errno);
    const std::lock_guard lock(registry().mutex);
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) failToWrite(path_, errno);
    registry().files.erase(temporary_);
    renamed_ = true;
}

void removeTemporaryFilesForGood() {
    registry().mutex.lock(); // and never unlocked
    for (const fs::path& file : registry().files)
        ::unlink(file.c_str());
}

// --- Checksums -----------------------------------------------------------------------------------

uint32_t checksumOfFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> piece(1 << 20);
    uLong sum = crc32(0, nullptr, 0);
    while (stream) {
        stream.read(piece.data(), std::streamsize(piece.size()));
        sum = crc32_z(sum, reinterpret_cast<const Bytef*>(piece.data()), size_t(stream.gcount()));
    }
    return uint32_t(sum);
}

// --- Standard output -----------------------------------------------------------------------------

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
