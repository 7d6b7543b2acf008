// Tables that pick one of many weights.
#include "host/kernel/sampling_tables.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace stromboli {
namespace {

/// Probability of each index that a table gives.
std::vector<double> probabilities(const std::vector<AliasColumn>& table) {
    std::vector<double> p(table.size(), 0.0);
    for (size_t i = 0; i < table.size(); ++i) {
        p[i] += table[i].threshold / double(table.size());
        p[table[i].alias] += (1 - table[i].threshold) / double(table.size());
    }
    return p;
}

TEST(AliasTable, GivesTheWeights) {
    std::mt19937 random(1);
    for (size_t n : {1u, 2u, 3u, 10u, 1000u}) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = std::exponential_distribution<>(1)(random);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        const std::vector<double> p = probabilities(buildAliasTable(weights));
        for (size_t i = 0; i < n; ++i)
            EXPECT_NEAR(p[i], weights[i] / sum, 1e-12);
    }
}

TEST(AliasTable, NeverPicksAWeightOfZero) {
    for (const std::vector<double>& weights :
         {std::vector<double>{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {0, 0, 1}, {0.1, 0, 0.1, 0, 0.1}}) {
        const std::vector<AliasColumn> table = buildAliasTable(weights);
        for (size_t i = 0; i < weights.size(); ++i) {
            EXPECT_TRUE(weights[i] > 0 || table[i].threshold == 0);
            EXPECT_TRUE(table[i].threshold == 1 || weights[table[i].alias] > 0);
        }
    }
}

} // namespace
} // namespace stromboli
