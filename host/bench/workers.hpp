#pragma once

#include <cstdint>
#include <functional>

namespace stromboli::bench {

/// Cuts 0 .. count-1 into blocks, which `threads` threads take one after the other; `start` is
/// called first in each of them. Returns when all is done.
void forBlocks(uint32_t threads, uint64_t count, uint64_t blockSize,
               const std::function<void()>& start,
               const std::function<void(uint64_t first, uint64_t count)>& work);

} // namespace stromboli::bench
