#include "host/bench/measuring.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace stromboli::bench {
namespace {

TEST(Workers, EveryItemOnceWhateverTheThreadsAndBlocks) {
    for (const uint32_t threads : {1u, 2u, 7u})
        for (const uint64_t block : {1u, 8u, 1000u}) {
            std::vector<std::atomic<int>> seen(101);
            std::atomic<uint32_t> starts{0};
            forBlocks(
                threads, seen.size(), block, [&] { ++starts; },
                [&](uint64_t first, uint64_t count) {
                    for (uint64_t i = first; i < first + count; ++i)
                        ++seen[i];
                });
            EXPECT_EQ(starts, threads);
            for (const std::atomic<int>& n : seen)
                EXPECT_EQ(n, 1);
        }
}

} // namespace
} // namespace stromboli::bench
