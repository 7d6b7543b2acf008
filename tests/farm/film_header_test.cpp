// What films say of themselves, why they are refused, and what they lack.
#include "host/core/error.hpp"
#include "tests/farm/films.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

FilmHeader sumOf(std::vector<ShareName> shares, const FilmHeader& picture = pictureOf(64, 1)) {
    FilmHeader sum = ofShare(picture, shares.front());
    for (size_t i = 1; i < shares.size(); ++i)
        add(sum, ofShare(picture, shares[i]), "part.film");
    return sum;
}

TEST(FilmHeader, ComesBackAsItWas) {
    const FilmHeader h = sumOf({{1, 4}, {3, 4}});
    const FilmHeader back = filmHeaderFromBytes(toBytes(h), "a.film");
    EXPECT_EQ(toBytes(back), toBytes(h));
    EXPECT_EQ(back.command, h.command);
    EXPECT_EQ(back.shares, h.shares);
    EXPECT_EQ(back.blocks, (std::vector<BlockRange>{{0, 16}, {32, 48}}));
    EXPECT_EQ(back.samples(), 32u);
}

TEST(FilmHeader, RefusesWhatMakesNoSense) {
    const auto refusal = [](const std::function<void(FilmHeader&)>& change) {
        FilmHeader h = sumOf({{1, 4}, {3, 4}});
        change(h);
        return refusalOf([&] { filmHeaderFromBytes(toBytes(h), "a.film"); });
    };
    EXPECT_EQ(refusal([](FilmHeader&) {}), "");
    const char* const kNonsense = "a.film: the film makes no sense";
    EXPECT_EQ(refusal([](FilmHeader& h) { h.settings.budget.samplesPerBlock = 0; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.settings.area.width = 0; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.blocks[1].end = 65; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.blocks[1].first = 15; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.shares[0].index = 5; }), kNonsense);
}

/// Headers of planned rounds and layers, too.
TEST(FilmHeader, RefusesRoundsAndLayersThatMakeNoSense) {
    const auto refusal = [](const std::function<void(FilmHeader&)>& change) {
        FilmHeader h = sumOf({{1, 4}});
        h.layers = {Layer::Depth};
        h.holdsLayers = true;
        h.planned = {{42, 1000, 400, {{1, 3}, {2, 3}}, {{0, 7}, {9, 12}}}};
        change(h);
        return refusalOf([&] { filmHeaderFromBytes(toBytes(h), "a.film"); });
    };
    EXPECT_EQ(refusal([](FilmHeader&) {}), "");
    const char* const kNonsense = "a.film: the film makes no sense";
    EXPECT_EQ(refusal([](FilmHeader& h) { h.planned[0].held = 1001; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.planned[0].samples = uint64_t(1) << 50; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.planned[0].shares[1].index = 4; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.planned[0].places[1].first = 6; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.planned[0].places[1].end = kSide * kSide + 1; }),
              kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.layers = {Layer(77)}; }), kNonsense);
    EXPECT_EQ(refusal([](FilmHeader& h) { h.layers.clear(); }), kNonsense);
}

TEST(FilmHeader, OfManySharesInAnyOrderAreTheSame) {
    const FilmHeader a = sumOf({{1, 4}, {2, 4}, {3, 4}, {4, 4}});
    const FilmHeader b = sumOf({{3, 4}, {1, 4}, {4, 4}, {2, 4}});
    EXPECT_EQ(toBytes(a), toBytes(b));
    EXPECT_TRUE(a.isComplete());
    EXPECT_EQ(a.blocks, (std::vector<BlockRange>{{0, 64}}));
}

TEST(FilmHeader, NamesWhatIsMissing) {
    EXPECT_EQ(missingFrom(sumOf({{1, 4}, {2, 4}, {4, 4}})), "share 3 of 4 is missing");
    EXPECT_EQ(missingFrom(sumOf({{2, 4}, {3, 4}})), "shares 1 and 4 of 4 are missing");
    EXPECT_EQ(missingFrom(sumOf({{2, 9}, {5, 9}, {9, 9}})),
              "shares 1, 3 to 4 and 6 to 8 of 9 are missing");
    EXPECT_EQ(missingFrom(sumOf({{1, 4}, {2, 2}})), "samples 16 to 31 of each pixel are missing");
    EXPECT_FALSE(sumOf({{1, 4}, {2, 2}}).isComplete());
    EXPECT_TRUE(sumOf({{1, 4}, {2, 4}, {2, 2}}).isComplete());
}

TEST(FilmHeader, RefusesWhatIsThereTwice) {
    EXPECT_EQ(refusalOf([] {
                  sumOf({{1, 4}, {3, 4}, {1, 4}});
              }),
              "part.film: share 1/4 would be counted twice");
    EXPECT_EQ(refusalOf([] {
                  sumOf({{1, 2}, {2, 4}});
              }),
              "part.film: samples 16 to 31 of each pixel would be counted twice");
    // Without samples, too: something is wrong with a list that names it twice.
    EXPECT_EQ(refusalOf([] {
                  sumOf({{1, 100}, {1, 100}}, pictureOf(4, 1));
              }),
              "part.film: share 1/100 would be counted twice");
}

TEST(FilmHeader, SaysWhatDiffers) {
    const FilmHeader picture = pictureOf(64, 16);
    const auto difference = [&](const std::function<void(FilmHeader&)>& change) {
        FilmHeader other = picture;
        change(other);
        return differenceOf(picture, other);
    };
    EXPECT_EQ(difference([](FilmHeader&) {}), "");
    EXPECT_EQ(difference([](FilmHeader& h) { h.identity.scene = h.scene = "moved.dae"; }), "");
    EXPECT_EQ(difference([](FilmHeader& h) { h.identity.program = "0.1.1"; }), "");
    EXPECT_THAT(difference([](FilmHeader& h) { h.identity.code = "9", h.identity.program = "2"; }),
                HasSubstr("another build of the program, 2, which takes other samples than 0.1.0"));
    EXPECT_THAT(difference([](FilmHeader& h) { h.identity.sceneSum = 43; }),
                HasSubstr("another scene or camera"));
    EXPECT_THAT(difference([](FilmHeader& h) { h.identity.backend = "reference"; }),
                HasSubstr("the backend reference, not vulkan"));
    EXPECT_THAT(difference([](FilmHeader& h) { h.identity.device = "another"; }),
                HasSubstr("another kind of device, another, not a device"));
    EXPECT_THAT(difference([](FilmHeader& h) {
                    h.settings.area.crop = {1, 2, 3, 4};
                }),
                HasSubstr("another size or part of the picture, 3 x 4 pixels"));
    EXPECT_THAT(difference([](FilmHeader& h) { h.settings.budget.mostSamplesPerPixel = 128; }),
                HasSubstr("of 128 samples a pixel, not of 64 (-s)"));
    EXPECT_THAT(difference([](FilmHeader& h) { h.settings.budget.samplesPerBlock = 8; }),
                HasSubstr("blocks of 8 samples, not of 16 (--block)"));
    EXPECT_THAT(difference([](FilmHeader& h) { // as --branches 4 has it
                    h.settings.estimator.branches = 4;
                    h.settings.budget.mostSamplesPerPixel /= 4;
                    h.settings.budget.samplesPerBlock /= 4;
                }),
                HasSubstr("has 4 branches a sample, not 1 (--branches)"));
    EXPECT_THAT(difference([](FilmHeader& h) { // as another -s has it, of which branches follow
                    h.settings.estimator.branches = 2;
                    h.settings.budget.samplesPerBlock /= 2;
                }),
                HasSubstr("of 128 samples a pixel, not of 64 (-s)"));
    EXPECT_THAT(difference([](FilmHeader& h) { h.settings.estimator.seed = 1; }),
                HasSubstr("is of other settings: stromboli render room.dae --even"));
}

} // namespace
} // namespace stromboli
