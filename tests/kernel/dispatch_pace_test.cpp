// How long dispatches run.
#include "host/kernel/kernel_tuning.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace stromboli {
namespace {

TEST(DispatchPace, ApproachesTheTargetTime) {
    DispatchPace pace(0.1, 5000);
    for (int i = 0; i < 20; ++i)
        pace.took(pace.iterations() * 1e-4); // 0.1 ms an iteration
    EXPECT_EQ(pace.iterations(), 1024u);     // of 1000
    for (int i = 0; i < 20; ++i)
        pace.took(1e-9);
    EXPECT_EQ(pace.iterations(), 5000u);
    for (int i = 0; i < 40; ++i)
        pace.took(100);
    EXPECT_EQ(pace.iterations(), 16u);
}

/// A driver that makes code for each number of iterations makes few.
TEST(DispatchPace, TakesFewNumbersHoweverTimesVary) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> busy(0.3, 3);
    DispatchPace pace(0.1, 5000);
    std::set<uint32_t> numbers;
    for (int i = 0; i < 1000; ++i) {
        numbers.insert(pace.iterations());
        pace.took(pace.iterations() * 1e-4 * busy(random));
    }
    EXPECT_LE(numbers.size(), 10u); // 16, 32, ... 4096 and the limit
}

} // namespace
} // namespace stromboli
