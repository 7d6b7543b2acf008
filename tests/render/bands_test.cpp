// Pictures in bands: where they are cut, and what is known of them together.
#include "host/film/shown_film.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/picture_noise.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

TEST(Bands, CoverWhatIsRenderedOnceAndInOrder) {
    for (const PictureArea& area : {PictureArea{100, 77, {}}, {100, 77, {20, 30, 50, 40}}})
        for (const uint64_t pixels : {1u, 99u, 500u, 3000u, 100000u}) {
            const Crop all = area.rendered();
            uint32_t row = all.y;
            for (const PictureArea& band : bandsOf(area, pixels)) {
                const Crop part = band.rendered();
                EXPECT_EQ(band.width, area.width);
                EXPECT_EQ(band.height, area.height);
                EXPECT_EQ(part.x, all.x);
                EXPECT_EQ(part.width, all.width);
                EXPECT_EQ(part.y, row);
                EXPECT_GT(part.height, 0u);
                EXPECT_TRUE(band.pixelCount() <= pixels || part.height == 1);
                row += part.height;
            }
            EXPECT_EQ(row, all.y + all.height);
        }
}

TEST(Bands, APictureThatFitsIsOne) {
    const PictureArea area{100, 77, {}};
    ASSERT_EQ(bandsOf(area, 7700).size(), 1u);
    EXPECT_EQ(bandsOf(area, 7700)[0].crop.width, 0u); // as it was
    EXPECT_EQ(bandsOf(area, 7699).size(), 2u);
}

/// Checkpoints of bands are named by their number alone.
TEST(Bands, TheirNumberSaysWhereTheyAre) {
    const PictureArea area{100, 77, {20, 30, 50, 40}};
    for (const uint64_t pixels : {99u, 500u, 1100u}) {
        const std::vector<PictureArea> bands = bandsOf(area, pixels);
        const std::vector<PictureArea> again = inBands(area, uint32_t(bands.size()));
        ASSERT_EQ(again.size(), bands.size());
        for (size_t i = 0; i < bands.size(); ++i) {
            EXPECT_EQ(again[i].crop.y, bands[i].crop.y);
            EXPECT_EQ(again[i].crop.height, bands[i].crop.height);
        }
    }
}

TEST(Bands, NoiseIsTheMeanOfSquares) {
    using Unknown = PictureNoise::Unknown;
    const PartNoise a{{Unknown::No, 0.3, 0.1, 0.5}, 100}, b{{Unknown::No, 0.4, 0.2, 0.6}, 300};
    const PartNoise black{{Unknown::Black}, 400}, unknown{{Unknown::TooFewSamples}, 1};
    const PictureNoise both = togetherOf(std::array{a, b});
    EXPECT_TRUE(both.known());
    EXPECT_DOUBLE_EQ(both.estimate, std::sqrt((0.09 * 100 + 0.16 * 300) / 400));
    EXPECT_DOUBLE_EQ(both.least, std::sqrt((0.01 * 100 + 0.04 * 300) / 400));
    EXPECT_DOUBLE_EQ(both.most, std::sqrt((0.25 * 100 + 0.36 * 300) / 400));
    EXPECT_DOUBLE_EQ(togetherOf(std::array{a, black}).estimate, std::sqrt(0.09 * 100 / 500));
    EXPECT_EQ(togetherOf(std::array{a, unknown}).unknown, Unknown::TooFewSamples);
    EXPECT_EQ(togetherOf(std::array{black, black}).unknown, Unknown::Black);
    EXPECT_DOUBLE_EQ(togetherOf(std::array{a}).estimate, 0.3);
}

TEST(Bands, BrightnessIsThatOfAll) {
    const PartBrightness dark{{.unlit = true, .darkShare = 1}, 100};
    const PartBrightness lit{{.darkShare = 0, .whiteShare = 0.5, .exposure = -1.0}, 300};
    const PartBrightness bright{{.darkShare = 0, .whiteShare = 1, .exposure = -4.0}, 100};
    const Brightness all = togetherOf(std::array{dark, lit, bright});
    EXPECT_FALSE(all.unlit);
    EXPECT_DOUBLE_EQ(all.darkShare, 0.2);
    EXPECT_DOUBLE_EQ(all.whiteShare, (150 + 100) / 500.0);
    EXPECT_EQ(all.exposure, -4.0);
    EXPECT_TRUE(togetherOf(std::array{dark, dark}).unlit);
}

} // namespace
} // namespace stromboli
