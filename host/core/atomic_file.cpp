#include "host/core/atomic_file.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace stromboli {

namespace fs = std::filesystem;

[[noreturn]] static void fail(const fs::path& path, const std::string& reason) {
    throw OutputError(fmt::format("{}: cannot write: {}", path.string(), reason));
}

static std::string systemReason(int error) {
    return std::generic_category().message(error);
}

/// The file that `path` stands for once symbolic links are followed; it need not exist.
static fs::path followLinks(const fs::path& path) {
    constexpr int kMostLinks = 40; // as the Linux kernel (MAXSYMLINKS)
    fs::path target = path;
    std::error_code error;
    for (int i = 0; fs::is_symlink(target, error); ++i) {
        if (i == kMostLinks) fail(path, systemReason(ELOOP));
        target = target.parent_path() / fs::read_symlink(target, error);
        if (error) fail(path, error.message());
    }
    return target;
}

static fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

static void checkTarget(const fs::path& path) {
    const fs::path folder = folderOf(path);
    std::error_code error;
    const fs::file_status folderStatus = fs::status(folder, error);
    if (folderStatus.type() == fs::file_type::not_found)
        fail(path, fmt::format("the folder {} does not exist", folder.string()));
    if (error) fail(path, error.message());
    if (!fs::is_directory(folderStatus))
        fail(path, fmt::format("{} is not a folder", folder.string()));

    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) fail(path, "it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) fail(path, "it is not a regular file");
    if (fs::exists(status) && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
        fail(path, systemReason(errno));
}

namespace {

/// A new file in the folder of `path`, removed again unless renamed to `path`.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& path) : path_(path) {
        const std::string stem =
            fmt::format(".{}.{}", path.filename().string(), static_cast<long>(::getpid()));
        // A process killed earlier may have left a file of the same number behind.
        for (int attempt = 0; descriptor_ < 0; ++attempt) {
            temporary_ = folderOf(path) / fmt::format("{}.{}.tmp", stem, attempt);
            descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno != EEXIST) {
                const int error = errno;
                fail(path, fmt::format("no file can be made in the folder {}: {}",
                                       folderOf(path).string(), systemReason(error)));
            }
        }
    }

    ~TemporaryFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!renamed_) ::unlink(temporary_.c_str());
    }

    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail(path_, systemReason(errno));
            bytes = bytes.subspan(static_cast<size_t>(written));
        }
    }

    /// Some file systems report a full disk only when the data are flushed or the file is closed.
    void rename(Sync sync) {
        if (sync == Sync::Now && ::fsync(descriptor_) != 0) fail(path_, systemReason(errno));
        const int closed = ::close(descriptor_);
        descriptor_ = -1;
        if (closed != 0) fail(path_, systemReason(errno));
        if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, systemReason(errno));
        renamed_ = true;
    }

  private:
    fs::path path_, temporary_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

} // namespace

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

} // namespace stromboli
