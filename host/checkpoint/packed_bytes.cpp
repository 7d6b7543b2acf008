#include "host/checkpoint/packed_bytes.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <new>

namespace stromboli {

uint32_t checksumOf(std::span<const std::byte> bytes) {
    return uint32_t(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), z_size_t(bytes.size())));
}

void append(std::vector<std::byte>& bytes, const void* data, size_t size) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}

void append(std::vector<std::byte>& bytes, const std::string& text) {
    append(bytes, uint64_t(text.size()));
    append(bytes, text.data(), text.size());
}

std::span<const std::byte> ByteParts::take(uint64_t size) {
    if (size > bytes_.size())
        throw UsageError(fmt::format("{}: the {} is cut short", file_->string(), kind_));
    const auto part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return part;
}

std::string ByteParts::text() {
    const auto part = take(number<uint64_t>());
    return {reinterpret_cast<const char*>(part.data()), part.size()};
}

namespace {

/// The fastest of Zstandard's usual levels. The sums of the kernel are floats in the place of
/// doubles: half of their bytes are zero, which any level finds.
constexpr int kLevel = 1;

} // namespace

std::vector<std::byte> compressed(std::span<const std::byte> bytes) {
    std::vector<std::byte> result(ZSTD_compressBound(bytes.size()));
    const size_t size =
        ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), kLevel);
    if (ZSTD_isError(size)) throw std::bad_alloc(); // the buffer is large enough for all there is
    result.resize(size);
    return result;
}

std::optional<std::vector<std::byte>> decompressed(std::span<const std::byte> bytes,
                                                   uint64_t size) {
    // Before memory is asked for: what is said of the size may be damaged.
    if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size) return std::nullopt;
    std::vector<std::byte> result(size);
    if (ZSTD_decompress(result.data(), result.size(), bytes.data(), bytes.size()) != size)
        return std::nullopt;
    return result;
}

} // namespace stromboli
