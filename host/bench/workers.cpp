#include "host/bench/workers.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace stromboli::bench {

void forBlocks(uint32_t threads, uint64_t count, uint64_t blockSize,
               const std::function<void()>& start,
               const std::function<void(uint64_t first, uint64_t count)>& work) {
    std::atomic<uint64_t> next{0};
    const auto takeBlocks = [&] {
        start();
        for (uint64_t first; (first = next.fetch_add(blockSize)) < count;)
            work(first, std::min(blockSize, count - first));
    };
    std::vector<std::jthread> workers;
    for (uint32_t i = 0; i < threads; ++i)
        workers.emplace_back(takeBlocks);
}

} // namespace stromboli::bench
