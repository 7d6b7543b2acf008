// Renders in blocks, with samples that need no renderer.
#include "host/core/error.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/farm/films.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

Film renderInBlocks(uint32_t samples, uint32_t perBlock) {
    RenderSettings s = settingsOf(samples);
    s.budget.samplesPerBlock = perBlock;
    BlockBackend backend(std::make_shared<DrawnBackend>(uneven, 1), s.area, perBlock);
    return render(backend, s);
}

bool sameFilms(const Film& a, const Film& b) {
    for (size_t i = 0; i < a.pixels.size(); ++i)
        if (a.pixels[i].taken() != b.pixels[i].taken() || a.pixels[i].mean != b.pixels[i].mean ||
            a.pixels[i].m2 != b.pixels[i].m2)
            return false;
    return true;
}

TEST(SampleBlocks, SharesAreAllOfThemOnce) {
    for (uint32_t samples : {1u, 5u, 64u, 1000u})
        for (uint32_t perBlock : {1u, 3u, 64u})
            for (uint32_t shares : {1u, 2u, 7u, 64u, 1000u, 1'000'000u}) {
                const SampleBlocks blocks{samples, perBlock};
                uint32_t next = 0, most = 0, least = samples;
                for (uint32_t i = 1; i <= std::min(shares, 2000u); ++i) {
                    const BlockRange range = blocks.ofShare(i, shares);
                    EXPECT_EQ(range.first, next);
                    next = range.end;
                    most = std::max(most, range.end - range.first);
                    least = std::min(least, range.end - range.first);
                }
                if (shares <= 2000) {
                    EXPECT_EQ(next, blocks.count());
                    EXPECT_LE(most - least, 1u); // work is given out evenly
                }
                EXPECT_EQ(blocks.firstOf(blocks.count()), samples);
            }
}

TEST(BlockBackend, HasTheSamplesOfARenderWithoutBlocks) {
    const Film blocks = renderInBlocks(100, 7);
    const Film plain = renderDrawn(uneven, settingsOf(100), 1).film;
    for (size_t i = 0; i < plain.pixels.size(); ++i) {
        EXPECT_EQ(blocks.pixels[i].count, 100u);
        EXPECT_NEAR(blocks.pixels[i].mean.x / plain.pixels[i].mean.x, 1, 1e-13); // 100 roundings
        EXPECT_NEAR(blocks.pixels[i].m2.x / plain.pixels[i].m2.x, 1, 1e-11);
    }
}

/// For more samples later, as --resume has it: the blocks that are done are not begun anew.
TEST(BlockBackend, GoesOnToMoreSamplesWithTheSameBytes) {
    RenderSettings s = settingsOf(100);
    s.budget.samplesPerBlock = 16;
    BlockBackend first(std::make_shared<DrawnBackend>(uneven, 1), s.area, 16);
    SamplingSession session(first, s);
    while (session.pass()) {
    }
    SessionState state = sessionFromBytes(toBytes(session.save()));
    EXPECT_EQ(state.blocks.front().taken(), 96u);
    EXPECT_EQ(state.pixels.statistics(0).count, 4u);
    state.settings.budget.mostSamplesPerPixel = 250;
    BlockBackend second(std::make_shared<DrawnBackend>(uneven, 1), s.area, 16);
    SamplingSession more(second, state);
    EXPECT_TRUE(sameFilms(more.film(), session.film()));
    while (more.pass()) {
    }
    EXPECT_TRUE(sameFilms(more.film(), renderInBlocks(250, 16)));
}

TEST(BlockBackend, PixelsWithUnequalSamplesHaveNoBlocks) {
    const RenderSettings s = settingsOf(100);
    BlockBackend backend(std::make_shared<DrawnBackend>(uneven, 1), s.area, 16);
    Film film(s.area);
    const std::vector<PixelTarget> one = {{3, 20}};
    EXPECT_THROW(backend.sample(one, film, {}), std::logic_error);
}

/// Any blocks are an unbiased picture: their mean over all pixels and seeds is that of the samples,
/// 1, within 4.5 standard errors (false alarm below 1e-5).
TEST(BlockBackend, AnyShareIsUnbiased) {
    for (const ShareName share : {ShareName{1, 4}, {3, 4}, {64, 64}}) {
        PixelStatistics means;
        for (uint32_t seed = 0; seed < 8; ++seed)
            for (const SharedPixel& p : drawBlocks(ofShare(pictureOf(64, 1), share), even, seed)) {
                EXPECT_EQ(p.all.taken(), 64 / share.count);
                means.add(p.all.statistics().mean);
            }
        EXPECT_NEAR(means.mean.x, 1, 4.5 * std::sqrt(means.varianceOfMean().x));
    }
}

} // namespace
} // namespace stromboli
