#include "host/study/folder_lock.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace stromboli::study {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0)
        throw OutputError(fmt::format("{}: no file can be made in the folder: {}", folder.string(),
                                      std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    const int reason = errno;
    ::close(descriptor_);
    if (reason == EWOULDBLOCK)
        throw OutputError(
            fmt::format("{}: another study is writing to this folder; wait for it, or "
                        "name another folder with -o",
                        folder.string()));
    throw OutputError(fmt::format("{}: {}", folder.string(), std::strerror(reason)));
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

} // namespace stromboli::study
