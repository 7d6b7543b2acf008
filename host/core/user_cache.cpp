#include "host/core/user_cache.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>

namespace stromboli {

namespace fs = std::filesystem;

namespace {

/// Tells our files from others in a folder that the user named.
constexpr std::string_view kEnding = ".stromboli-cache";

struct Header {
    std::array<char, 8> magic{'S', 'T', 'R', 'B', 'L', 'O', 'B', '\n'};
    uint32_t version = 1;
    uint32_t checksum = 0; ///< CRC-32 of the blob
    uint64_t bytes = 0;    ///< of the blob
};
static_assert(sizeof(Header) == 24 && std::is_trivially_copyable_v<Header>);

uint32_t checksumOf(std::span<const std::byte> blob) {
    return uint32_t(
        crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(blob.data()), blob.size()));
}

Header headerOf(std::span<const std::byte> blob) {
    Header header;
    header.checksum = checksumOf(blob);
    header.bytes = blob.size();
    return header;
}

/// The value of an environment variable if it is an absolute path, as the XDG specification asks.
std::optional<fs::path> absoluteFolder(const char* variable) {
    const char* value = std::getenv(variable);
    if (!value || !fs::path(value).is_absolute()) return std::nullopt;
    return fs::path(value);
}

} // namespace

std::optional<fs::path> userCacheFolder() {
    if (const char* own = std::getenv("STROMBOLI_CACHE_DIR"))
        return *own ? std::optional<fs::path>(own) : std::nullopt;
    if (const auto caches = absoluteFolder("XDG_CACHE_HOME")) return *caches / "stromboli";
    if (const auto home = absoluteFolder("HOME")) return *home / ".cache" / "stromboli";
    return std::nullopt;
}

fs::path BlobCache::pathOf(const std::string& name) const {
    return folder_ / (name + std::string(kEnding));
}

std::optional<std::vector<std::byte>> BlobCache::find(const std::string& name) const {
    const fs::path path = pathOf(name);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    Header header;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
    if (header.magic != Header().magic || header.version != Header().version ||
        header.bytes > kMostBytes)
        return std::nullopt;
    std::vector<std::byte> blob(header.bytes);
    if (!file.read(reinterpret_cast<char*>(blob.data()), std::streamsize(blob.size())) ||
        file.peek() != std::ifstream::traits_type::eof() || checksumOf(blob) != header.checksum) {
        tell(messages_, Severity::Detail, fmt::format("{}: damaged, ignored", path.string()));
        return std::nullopt;
    }
    return blob;
}

void BlobCache::keep(const std::string& name, std::span<const std::byte> blob) const try {
    const fs::path path = pathOf(name);
    if (blob.size() > kMostBytes) {
        fs::remove(path);
        return;
    }
    fs::create_directories(folder_);
    const Header header = headerOf(blob);
    std::vector<std::byte> bytes(sizeof header + blob.size());
    std::memcpy(bytes.data(), &header, sizeof header);
    std::copy(blob.begin(), blob.end(), bytes.begin() + sizeof header);
    writeFileAtomically(path, bytes, Sync::Later); // the checksum guards against power cuts
    removeOldest();
} catch (const std::exception& reason) { // no permission, full disk, a file in the folder's place
    tell(messages_, Severity::Detail, fmt::format("nothing kept in the cache: {}", reason.what()));
}

/// Also takes away temporary files of programs that were killed while they wrote.
void BlobCache::removeOldest() const {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
        if (entry.path().filename().string().find(kEnding) != std::string::npos)
            files.emplace_back(entry.last_write_time(), entry.path());
    if (files.size() <= most_) return;
    std::sort(files.begin(), files.end());
    for (size_t i = 0; i + most_ < files.size(); ++i)
        fs::remove(files[i].second);
}

} // namespace stromboli
