#include "host/core/atomic_file.hpp"

#include "host/core/temporary_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <sys/statvfs.h>
#include <system_error>
#include <unistd.h>

namespace stromboli {

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

} // namespace stromboli
