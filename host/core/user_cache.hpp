#pragma once

#include "host/core/messages.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

/// The folder for what may be deleted at any time: STROMBOLI_CACHE_DIR, or else the folder
/// "stromboli" of $XDG_CACHE_HOME or ~/.cache (XDG Base Directory Specification, version 0.8). It
/// need not exist. None if STROMBOLI_CACHE_DIR is empty or there is no home.
std::optional<std::filesystem::path> userCacheFolder();

/// Blobs kept between runs, each under a name in one folder. A cache is a help, never a need: what
/// cannot be read is as good as absent, what cannot be written is not, and neither is an error.
///
/// Each blob has a file of its own with a header of magic number, format version, length and
/// CRC-32, so that a file cut short, damaged or of another version is never taken for a blob. It
/// is replaced in one step: programs that run at the same time see an old one or a new one, and
/// the last to write stays.
class BlobCache {
  public:
    /// Larger blobs are neither kept nor read.
    static constexpr uint64_t kMostBytes = uint64_t(16) << 20;
    /// Blobs in a folder, if its user asks for no other number.
    static constexpr size_t kMostBlobs = 8;

    /// `messages`: who is told, in detail, of files that are damaged or cannot be written. `most`:
    /// blobs in the folder; when one is kept, those that were written longest ago make room.
    explicit BlobCache(std::filesystem::path folder, Messages messages = {},
                       size_t most = kMostBlobs)
        : folder_(std::move(folder)), messages_(std::move(messages)), most_(most) {}

    /// One in a folder of that name within this one's.
    BlobCache within(const std::string& name, size_t most) const {
        return BlobCache(folder_ / name, messages_, most);
    }

    /// The blob last kept under `name`.
    std::optional<std::vector<std::byte>> find(const std::string& name) const;
    /// Keeps `blob` under `name`, a file name; makes the folder if need be. A blob that is too
    /// large takes away what was kept under the name, so that the next run starts afresh.
    void keep(const std::string& name, std::span<const std::byte> blob) const;

  private:
    std::filesystem::path pathOf(const std::string& name) const;
    void removeOldest() const;

    std::filesystem::path folder_;
    Messages messages_;
    size_t most_;
};

} // namespace stromboli
