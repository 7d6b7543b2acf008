#include "host/render/kept_pixels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace stromboli {
namespace {

/// Pixels with i + 1 samples each, of 1, 2 and i, or states of two strands that have as many
/// together.
KeptPixels pixelsOf(KeptPixels::As as, uint32_t count) {
    KeptPixels kept{as, as == KeptPixels::As::States ? 2u : 1u, {}};
    for (uint32_t i = 0; i < count; ++i) {
        if (as == KeptPixels::As::Statistics) {
            PixelStatistics pixel;
            pixel.count = i + 1;
            pixel.mean = {1, 2, i};
            kept.append(pixel);
            continue;
        }
        std::array<gpu::PixelState, 2> strands{};
        for (uint32_t k = 0; k < 2; ++k) {
            strands[k].count = (i + 2 - k) / 2;
            strands[k].sum = float(strands[k].count) * glm::vec3(1, 2, i);
        }
        kept.append(strands);
    }
    return kept;
}

TEST(KeptPixels, AreWhatWasAppended) {
    for (const auto as : {KeptPixels::As::Statistics, KeptPixels::As::States}) {
        const KeptPixels kept = pixelsOf(as, 5);
        ASSERT_EQ(kept.count(), 5u);
        for (uint32_t i = 0; i < 5; ++i) {
            EXPECT_EQ(kept.statistics(i).count, i + 1);
            EXPECT_EQ(kept.statistics(i).mean, glm::dvec3(1, 2, i));
        }
    }
}

TEST(KeptPixels, PartsGoBackToTheirPlaces) {
    for (const auto as : {KeptPixels::As::Statistics, KeptPixels::As::States}) {
        const KeptPixels kept = pixelsOf(as, 7);
        KeptPixels other{as, kept.strands, {}};
        other.empty(7);
        EXPECT_EQ(other.statistics(6).taken(), 0u);
        EXPECT_EQ(other.statistics(6).firstRejected, PixelStatistics{}.firstRejected);
        for (const PixelRun run : {PixelRun{4, 3}, {0, 1}, {1, 3}})
            other.put(run, kept.part(run));
        EXPECT_EQ(other.bytes, kept.bytes);
        EXPECT_THROW(other.put({5, 3}, kept.part({0, 3})), std::invalid_argument);
        EXPECT_THROW(other.put({0, 2}, kept.part({0, 3})), std::invalid_argument);
    }
    KeptPixels states = pixelsOf(KeptPixels::As::States, 2);
    EXPECT_THROW(states.put({0, 1}, pixelsOf(KeptPixels::As::Statistics, 1)),
                 std::invalid_argument);
    EXPECT_THROW(pixelsOf(KeptPixels::As::Statistics, 1).states(), std::invalid_argument);
}

} // namespace
} // namespace stromboli
