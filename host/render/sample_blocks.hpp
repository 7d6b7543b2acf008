#pragma once

#include <algorithm>
#include <cstdint>

namespace stromboli {

/// Blocks of samples by their number, without the last.
struct BlockRange {
    uint32_t first = 0, end = 0;

    bool empty() const { return first == end; }
    auto operator<=>(const BlockRange&) const = default;
};

/// The samples of every pixel, cut into blocks that are added up by themselves, and then to each
/// other, exactly: whoever takes a block gets the same sums.
struct SampleBlocks {
    uint32_t samples = 0;  ///< of a pixel
    uint32_t perBlock = 1; ///< the last block may have fewer

    uint32_t count() const { return (samples + perBlock - 1) / perBlock; }
    /// The first sample of a block, or the number of all if there is no such block.
    uint32_t firstOf(uint32_t block) const {
        return uint32_t(std::min<uint64_t>(uint64_t(block) * perBlock, samples));
    }
    /// Those of share `index`, which counts from 1, of `shares`; there may be none. They follow
    /// each other: so many Sobol points in a row fill the gaps between each other best.
    BlockRange ofShare(uint32_t index, uint32_t shares) const {
        const auto before = [&](uint32_t i) { return uint32_t(uint64_t(count()) * i / shares); };
        return {before(index - 1), before(index)};
    }
};

} // namespace stromboli
