#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace stromboli::images {

/// What GPUs read pictures in: blocks of 4 x 4 texels of 8 or 16 bytes ("Khronos Data Format
/// Specification" 1.3, chapters "S3TC", "RGTC" and "BPTC").
enum class BlockCompression : uint8_t {
    Bc1,       ///< colours, and texels that are wholly transparent
    Bc2,       ///< colours, and alpha of four bits
    Bc3,       ///< colours and alpha
    Bc4,       ///< one channel
    Bc4Signed, ///< one channel in [-1, 1]
    Bc5,       ///< two channels
    Bc5Signed, ///< two channels in [-1, 1]
    Bc7,       ///< colours and alpha
};

constexpr size_t blockSize(BlockCompression kind) {
    return kind == BlockCompression::Bc1 || kind == BlockCompression::Bc4 ||
                   kind == BlockCompression::Bc4Signed
               ? 8
               : 16;
}

/// Red, green, blue and alpha of each texel of a block, row after row, as fractions of 255. One
/// channel is grey; two are red and green, with a blue of 0; of numbers in [-1, 1], -1 becomes 1
/// and 0 becomes 128. `bytes`: blockSize() of them.
using BlockTexels = std::array<std::array<uint8_t, 4>, 16>;
BlockTexels decodeBlock(BlockCompression kind, std::span<const uint8_t> bytes);

/// The texels of a block of BC7; those of modes that do not exist are transparent black.
BlockTexels decodeBc7(std::span<const uint8_t, 16> bytes);

} // namespace stromboli::images
