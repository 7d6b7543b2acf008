#include "host/core/pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace stromboli {
namespace {

constexpr size_t kMiB = size_t(1) << 20;
constexpr std::byte kMark{0x5A};

// An array in front of the first whole page of 2 MiB, or behind the last, is somebody else's.
TEST(Pages, OfTwoMiBAreTakenWithinTheMemoryAlone) {
    std::vector<std::byte> memory(9 * kMiB, kMark);
    const std::span<std::byte> inner(memory.data() + 3 * kMiB / 2 + 5, 5 * kMiB);
    takeHugePages(inner);
    const auto isMark = [](std::byte b) { return b == kMark; };
    EXPECT_TRUE(std::all_of(memory.data(), inner.data(), isMark));
    EXPECT_TRUE(std::all_of(inner.data() + inner.size(), memory.data() + memory.size(), isMark));
    std::ranges::fill(inner, std::byte(1));
    EXPECT_EQ(std::ranges::count(memory, std::byte(1)), ptrdiff_t(inner.size()));
}

TEST(Pages, OfLessThanTwoMiBNoneAreTaken) {
    std::vector<std::byte> memory(2 * kMiB - 1, kMark);
    takeHugePages(memory);
    takeHugePages({});
    EXPECT_EQ(std::ranges::count(memory, kMark), ptrdiff_t(memory.size()));
}

TEST(Pages, OfAnArrayKeepWhatIsWritten) {
    PageVector<int> numbers(6 * kMiB);
    std::iota(numbers.begin(), numbers.end(), 0);
    numbers.resize(12 * kMiB);
    for (size_t i = 0; i < 6 * kMiB; i += 1021)
        ASSERT_EQ(numbers[i], int(i));
}

} // namespace
} // namespace stromboli
