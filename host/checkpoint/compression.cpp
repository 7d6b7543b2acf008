#include "host/checkpoint/compression.hpp"

#include <zstd.h>

#include <new>

namespace stromboli {
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
