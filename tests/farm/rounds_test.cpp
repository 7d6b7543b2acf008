// Rounds of shares: the same bits however they are cut and put together, what is refused, where
// samples go, and that this does not darken the picture. Samples are drawn, without a renderer.
#include "host/core/error.hpp"
#include "host/farm/round_plan.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/farm/films.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

std::vector<SharedPixel> sumOf(const Files& files) {
    FilmsToMerge films(files);
    std::vector<SharedPixel> sum;
    films.addUp([&](const PictureArea&, std::span<const SharedPixel> run, std::span<const float>) {
        sum.insert(sum.end(), run.begin(), run.end());
    });
    return sum;
}

NextRound next(const Files& files, double noise, uint32_t most = kMostSamples) {
    FilmsToMerge films(files);
    return planNextRound(films, noise, most);
}

class Rounds : public testing::Test {
  protected:
    TemporaryFolder folder_;
    int files_ = 0;
    uint32_t seed_ = 1;

    fs::path newFile() { return folder_ / (std::to_string(++files_) + ".film"); }
    Files first(const FilmHeader& picture, uint32_t shares, const Draw& draw = uneven) {
        Files files;
        for (uint32_t i = 1; i <= shares; ++i) {
            const FilmHeader header = ofShare(picture, {i, shares});
            files.push_back(newFile());
            writeFilm(files.back(), header, drawBlocks(header, draw, seed_));
        }
        return files;
    }
    fs::path planned(const RoundPlan& plan, const ShareName& name, const Draw& draw = uneven) {
        const PlannedShare share = ofShare(plan, name);
        const fs::path file = newFile();
        writeFilm(file, share.header, drawPlanned(share, draw, seed_));
        return file;
    }
    Files planned(const RoundPlan& plan, uint32_t shares, const Draw& draw = uneven) {
        Files files;
        for (uint32_t i = 1; i <= shares; ++i)
            files.push_back(planned(plan, {i, shares}, draw));
        return files;
    }
    fs::path merged(const Files& files) {
        FilmsToMerge films(files);
        const fs::path file = newFile();
        FilmWriter writer(file, films.header());
        films.addUp(
            [&](const PictureArea&, std::span<const SharedPixel> run, std::span<const float>) {
                if (!films.header().isEmpty()) writer.add(run);
            });
        writer.finish();
        return file;
    }
};

Files operator+(Files a, const Files& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Three rounds in 1, 2 or 7 shares each, in any order, at once or by way of films of several: the
/// same sums, the same plans, and from the same shares the same film.
TEST_F(Rounds, AnyNumberOfSharesInAnyOrderAndGrouping) {
    const FilmHeader picture = pictureOf(56, 8);
    std::vector<SharedPixel> expected;
    std::vector<uint32_t> second, third; // what the plans ask for
    std::mt19937 random(1);
    for (const uint32_t shares : {1u, 2u, 7u}) {
        const Files one = first(picture, shares);
        const RoundPlan plan2 = next(one, 0.01).plan.value();
        const Files two = one + planned(plan2, 8 - shares);
        const RoundPlan plan3 = next(two, 0.01).plan.value();
        Files all = two + planned(plan3, shares);
        if (expected.empty()) expected = sumOf(all), second = plan2.to, third = plan3.to;
        EXPECT_EQ(plan2.to, second);
        EXPECT_EQ(plan3.to, third);
        EXPECT_EQ(plan3.from, second);
        EXPECT_EQ(sumOf(all), expected) << shares;
        const std::string atOnce = contentOf(merged(all));
        for (int trial = 0; trial < 4; ++trial) {
            std::ranges::shuffle(all, random);
            EXPECT_TRUE(contentOf(merged(all)) == atOnce);
            Files groups;
            for (size_t begin = 0; begin < all.size();) {
                const size_t end = std::min(all.size(), begin + 1 + random() % 4);
                groups.push_back(merged(
                    {all.begin() + std::ptrdiff_t(begin), all.begin() + std::ptrdiff_t(end)}));
                begin = end;
            }
            EXPECT_TRUE(contentOf(merged(groups)) == atOnce);
        }
    }
    for (size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(expected[i].all.taken(), third[i]);
}

/// Sample numbers go on: in the end a pixel has those from 0 to its count, each once.
TEST_F(Rounds, NoSampleIsTakenTwice) {
    const Files one = first(pictureOf(16, 4), 3);
    const Files two = one + planned(next(one, 0.01).plan.value(), 3);
    const Files three = two + planned(next(two, 0.01).plan.value(), 3);
    DrawnBackend backend(uneven, seed_);
    const std::vector<SharedPixel> sum = sumOf(three);
    for (uint32_t i = 0; i < sum.size(); ++i) {
        PixelStatistics expected;
        for (uint32_t n = 0; n < sum[i].all.taken(); ++n)
            expected.add(backend.sampleAlone(i, n).radiance);
        const PixelStatistics found = sum[i].all.statistics();
        ASSERT_NEAR(found.mean.x / expected.mean.x, 1, 1e-12);
        ASSERT_NEAR(found.m2.x / expected.m2.x, 1, 1e-10);
    }
}

/// The errors of the first round are those that a render in one go states.
TEST_F(Rounds, TheFirstOnesNoiseIsThatOfOneRender) {
    for (const uint32_t samples : {8u, 60u, 64u, 72u}) {
        RenderSettings s = settingsOf(samples);
        s.budget.samplesPerBlock = 4;
        BlockBackend backend(std::make_shared<DrawnBackend>(uneven, seed_), s.area, 4);
        RenderOutcome whole;
        render(backend, s, {}, &whole);
        const NextRound round = next(first(pictureOf(samples, 4), 2), 0.01);
        EXPECT_EQ(round.reached.estimate, whole.noise.estimate) << samples;
        EXPECT_EQ(round.reached.most, whole.noise.most) << samples;
    }
}

/// A later pass replaces what is known of the last one, and parts of it that come later still
/// count.
TEST(SharedPixel, KnowsTheLastPassInAnyOrder) {
    std::mt19937 random(1);
    std::vector<SharedPixel> parts;
    DrawnBackend backend(even, 1);
    const auto part = [&](uint32_t begin, uint32_t end, uint32_t pass) {
        PixelStatistics samples;
        for (uint32_t i = begin; i < end; ++i)
            samples.add(backend.sampleAlone(0, i).radiance);
        parts.emplace_back().add(samples, begin, pass);
        return samples;
    };
    PixelStatistics before = part(0, 8, 0);
    before.merge(part(8, 16, 1));
    PixelStatistics all = before;
    all.merge(part(16, 24, 2));
    all.merge(part(24, 32, 2));
    parts.emplace_back(); // a share that has nothing of this pixel
    const double moved = all.mean.x - before.mean.x;
    for (int trial = 0; trial < 20; ++trial) {
        std::ranges::shuffle(parts, random);
        SharedPixel left, right, sum;
        for (size_t i = 0; i < parts.size(); ++i)
            (i < 2 ? left : right).add(parts[i]);
        sum.add(right);
        sum.add(left);
        EXPECT_EQ(sum.lastPass, 2u);
        EXPECT_EQ(sum.lastCount, 16u);
        EXPECT_NEAR(sum.squaredError().x / (moved * moved), 1, 1e-9);
    }
}

/// Samples that a pixel filter weighs are of either sign, and so are their sums, those of the last
/// pass, and what is left of all when that is taken away.
TEST(SharedPixel, KnowsTheErrorOfSamplesOfBothSigns) {
    for (const glm::dvec3 weights : {glm::dvec3(1, -1, -1), glm::dvec3(-1, -1, 1),
                                     glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, -1)}) {
        SharedPixel pixel;
        for (uint32_t i = 0; i < 3; ++i) { // the last two are of the last pass
            PixelStatistics block;
            const double weight = weights[int(i)];
            block.add(glm::dvec3(8, 1, 0), weight);
            block.add(glm::dvec3(2, 5, 1), weight / 2);
            pixel.add(block, 2 * i, i == 0 ? 0 : 1);
        }
        const glm::dvec3 before = weights[0] * glm::dvec3(9, 3.5, 0.5) / 2.0;
        const glm::dvec3 now = (weights.x + weights.y + weights.z) * glm::dvec3(9, 3.5, 0.5) / 6.0;
        const glm::dvec3 expected = (now - before) * (now - before) * 2.0 / 4.0;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(pixel.squaredError()[c], expected[c], 1e-12) << weights.x << weights.y;
    }
}

TEST_F(Rounds, GoOnUntilTheNoiseIsWhatWasAskedFor) {
    Files films = first(pictureOf(16, 4), 2);
    int rounds = 1;
    for (;; ++rounds) {
        const NextRound round = next(films, 0.05);
        if (!round.plan) {
            EXPECT_LE(round.reached.most, 0.05);
            break;
        }
        EXPECT_GT(round.reached.most, 0.05);
        films = films + planned(*round.plan, 2);
    }
    EXPECT_GT(rounds, 3);
    EXPECT_LT(rounds, 12);
    Film film(kSide, kSide);
    const std::vector<SharedPixel> sum = sumOf(films);
    uint64_t noisy = 0, others = 0;
    for (uint32_t i = 0; i < sum.size(); ++i) {
        film.pixels[i] = sum[i].all.statistics();
        (i % kSide / 5 == 3 ? noisy : others) += sum[i].all.taken();
    }
    EXPECT_LT(std::sqrt(trueRelativeError(film)), 0.05);
    EXPECT_GT(double(noisy) / 5, 4 * double(others) / 43); // samples a column: where they help
}

TEST_F(Rounds, EndWhenAllPixelsHaveTheMostSamples) {
    Files films = first(pictureOf(16, 4), 1);
    while (const auto plan = next(films, 1e-6, 40).plan)
        films = films + planned(*plan, 1);
    for (const SharedPixel& p : sumOf(films))
        ASSERT_EQ(p.all.taken(), 40u);
}

/// After a first round that is too small to tell noise by, pixels are brought to eight samples at
/// once, in a picture of a single pixel as in larger ones.
TEST_F(Rounds, BeginWithEightSamplesInPicturesOfAnySize) {
    for (const uint32_t side : {1u, 2u, 7u}) {
        FilmHeader picture = pictureOf(2, 1);
        picture.settings.area = {side, side, {}};
        const NextRound round = next(first(picture, 2), 0.01);
        ASSERT_TRUE(round.plan) << side;
        EXPECT_EQ(round.plan->to, std::vector<uint32_t>(side * side, 8)) << side;
    }
}

TEST_F(Rounds, WhatIsMissingIsNamedAndNothingIsPlanned) {
    const Files one = first(pictureOf(16, 4), 2);
    const RoundPlan plan2 = next(one, 0.01).plan.value();
    const Files two = planned(plan2, 3);
    EXPECT_THAT(refusalOf([&] { next({one[0]}, 0.01); }), HasSubstr("share 2 of 2 is missing"));
    EXPECT_THAT(refusalOf([&] {
                    next({one[0], one[1], two[1]}, 0.01);
                }),
                HasSubstr("of round 2 shares 1 and 3 of 3 are missing"));
    const FilmsToMerge some({one[0], two[0], two[1]});
    EXPECT_EQ(missingFrom(some.header()), "of round 1 share 2 of 2 is missing; "
                                          "of round 2 share 3 of 3 is missing");
    EXPECT_EQ(some.header().samplesInAll(), 16u * kSide * kSide + plan2.samples());
    // A film of round 3 knows of round 2, and that it is not there.
    const RoundPlan plan3 = next(one + two, 0.01).plan.value();
    const FilmsToMerge gap(one + planned(plan3, 1));
    EXPECT_FALSE(gap.header().isComplete());
    EXPECT_EQ(missingFrom(gap.header()), "of round 2 all samples are missing");
}

TEST_F(Rounds, RefuseForeignPlansAndSharesThatComeTwice) {
    const Files one = first(pictureOf(16, 4), 2);
    const RoundPlan plan = next(one, 0.01).plan.value();
    const Files thirds = planned(plan, 3);
    const auto refusal = [&](const Files& files) {
        return refusalOf([&] { const FilmsToMerge films(files); });
    };
    EXPECT_EQ(refusal(one + thirds), "");
    EXPECT_THAT(refusal({one[0], thirds[1], thirds[1]}),
                HasSubstr("share 2/3 of round 2 would be counted twice"));
    EXPECT_THAT(refusal({thirds[0], planned(plan, {1, 2})}),
                HasSubstr("pixels would be counted twice"));
    EXPECT_EQ(refusal({planned(plan, {1, 2}), planned(plan, {3, 4}), planned(plan, {4, 4})}), "");
    RoundPlan other = plan;
    ++other.to[100];
    EXPECT_THAT(refusal({thirds[0], planned(other, {2, 3})}),
                HasSubstr("follows another plan of round 2"));
    // Where the second round had other plans, films of the third are strangers as well.
    RoundPlan later = plan, laterOfOther = plan;
    later.picture = ofShare(plan, {1, 1}).header;
    laterOfOther.picture = ofShare(other, {1, 1}).header;
    EXPECT_THAT(refusal({planned(later, {1, 2}), planned(laterOfOther, {2, 2})}),
                HasSubstr("follows another plan of round 2"));
    EXPECT_EQ(refusal({planned(later, {1, 2}), thirds[0]}), "");
}

/// A share that has no pixel is a film all the same.
TEST_F(Rounds, SharesWithoutSamplesDoNoHarm) {
    const Files one = first(pictureOf(16, 16), 1);
    RoundPlan plan = next(one, 0.01).plan.value();
    plan.to = plan.from;
    plan.to[5] += 8, plan.to[1000] += 8;
    const Files films = planned(plan, 7);
    EXPECT_EQ(std::ranges::count_if(
                  films, [](const fs::path& file) { return FilmReader(file).header().isEmpty(); }),
              5);
    EXPECT_EQ(sumOf(one + films), sumOf(one + planned(plan, 1)));
}

/// The case in which samples that decide about their own number do harm (noise_plan_test.cpp): a
/// quarter of the picture has rare light, one sample in 50. Over 400 seeds the picture's mean after
/// three rounds is 1 within a thousandth and three standard errors, as that of a render of one
/// machine.
TEST(RoundPlan, DoesNotDarken) {
    const Draw caustic = [](uint32_t pixel, Random& random) {
        if (pixel % kSide < 3 * kSide / 4) return gamma(0.5, random);
        return std::bernoulli_distribution(0.02)(random) ? 50.0 : 0.0;
    };
    constexpr uint32_t kSeeds = 400;
    double sum = 0, squares = 0, samples = 0;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        FilmHeader header = ofShare(pictureOf(16, 4), {1, 1});
        std::vector<SharedPixel> pixels = drawBlocks(header, caustic, seed);
        for (int round = 2; round <= 3; ++round) {
            NextRoundPlanner planner(header, 0.01, kMostSamples);
            planner.add(pixels);
            const PlannedShare share = ofShare(planner.finish().plan.value(), {1, 1});
            const std::vector<SharedPixel> more = drawPlanned(share, caustic, seed);
            for (size_t i = 0; i < pixels.size(); ++i)
                pixels[i].add(more[i]);
            add(header, share.header, "");
        }
        double mean = 0;
        for (const SharedPixel& p : pixels) {
            mean += p.all.statistics().mean.x / (kSide * kSide);
            samples += p.all.taken() / double(kSide * kSide * kSeeds);
        }
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / kSeeds;
    const double sigma = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
    std::printf("mean %.5f, standard error %.5f, %.1f samples a pixel\n", mean, sigma, samples);
    EXPECT_NEAR(samples, 64, 1);
    EXPECT_LT(sigma, 0.0006);
    EXPECT_LT(std::abs(mean - 1), 0.001 + 3 * sigma);
}

} // namespace
} // namespace stromboli
