// How long dispatches run.
#include "host/kernel/kernel_tuning.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

TEST(DispatchPace, ApproachesTheTargetTime) {
    DispatchPace pace(0.1, 5000);
    for (int i = 0; i < 20; ++i)
        pace.took(pace.iterations() * 1e-4); // 0.1 ms an iteration
    EXPECT_NEAR(pace.iterations(), 1000, 1);
    for (int i = 0; i < 20; ++i)
        pace.took(1e-9);
    EXPECT_EQ(pace.iterations(), 5000u);
    for (int i = 0; i < 40; ++i)
        pace.took(100);
    EXPECT_EQ(pace.iterations(), 16u);
}

} // namespace
} // namespace stromboli
