// Which pixels the sampling plan gives more samples. Films are made by hand: no renderer.
#include "host/render/sampling_plan.hpp"
#include "host/render/sampling_session.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli {
namespace {

RenderSettings adaptiveSettings(uint32_t width, uint32_t height) {
    RenderSettings s;
    s.area.width = width;
    s.area.height = height;
    s.budget.mostSamplesPerPixel = 1000;
    s.budget.adaptive = {.enabled = true, .batch = 32, .tolerance = 0.05};
    return s;
}

/// A pixel of `count` samples with this mean and standard deviation of one sample.
PixelStatistics pixel(uint32_t count, double mean, double sigma) {
    PixelStatistics p;
    p.count = count;
    p.mean = glm::dvec3(mean);
    p.m2 = glm::dvec3(sigma * sigma * (count - 1));
    return p;
}

Film filmOf(const RenderSettings& s, const PixelStatistics& p) {
    Film film(s.area.width, s.area.height);
    std::fill(film.pixels.begin(), film.pixels.end(), p);
    return film;
}

std::vector<PixelTarget> next(const RenderSettings& s, const Film& film) {
    return SamplingPlan(s.budget).next(film);
}

bool wants(const std::vector<PixelTarget>& pass, uint32_t pixel_) {
    return std::any_of(pass.begin(), pass.end(),
                       [&](const PixelTarget& t) { return t.pixel == pixel_; });
}

TEST(UniformPlan, QuadruplesUntilAllSamplesAreTaken) {
    RenderSettings s;
    s.area.width = 3, s.area.height = 2, s.budget.mostSamplesPerPixel = 100;
    std::vector<uint32_t> targets;
    Film film(3, 2);
    for (;;) {
        const auto pass = next(s, film);
        if (pass.empty()) break;
        EXPECT_EQ(pass.size(), 6u);
        targets.push_back(pass[0].samples);
        for (PixelStatistics& p : film.pixels)
            p.count = pass[0].samples;
    }
    EXPECT_EQ(targets, (std::vector<uint32_t>{16, 64, 100}));
}

/// Else nothing would say how large the error is that is left.
TEST(UniformPlan, TheLastPassGrowsThePictureByHalfAtLeast) {
    for (uint32_t most = 1; most <= 300; ++most) {
        RenderSettings s;
        s.area.width = 1, s.area.height = 1, s.budget.mostSamplesPerPixel = most;
        Film film(1, 1);
        uint32_t before = 0;
        for (auto pass = next(s, film); !pass.empty(); pass = next(s, film)) {
            before = film.pixels[0].count;
            ASSERT_GT(pass[0].samples, before);
            film.pixels[0].count = pass[0].samples;
        }
        EXPECT_EQ(film.pixels[0].count, most);
        if (most < SamplingPlan::kFirstPass) {
            EXPECT_EQ(before, 0u) << most; // all at once
        } else {
            EXPECT_LE(before, most - 1);
            EXPECT_GE(2 * before, most) << most;
        }
    }
}

TEST(UniformPlan, RejectedSamplesCountAsTaken) {
    RenderSettings s;
    s.area.width = 1, s.area.height = 1, s.budget.mostSamplesPerPixel = 10;
    Film film(1, 1);
    film.pixels[0].count = 7;
    film.pixels[0].rejected = 3;
    EXPECT_TRUE(next(s, film).empty());
}

TEST(PictureArea, CropIsRowsOfTheWholePicture) {
    const PictureArea area{10, 10, {3, 7, 2, 2}};
    std::vector<uint32_t> places;
    for (uint32_t i = 0; i < area.pixelCount(); ++i)
        places.push_back(area.placeOf(i).y * area.width + area.placeOf(i).x);
    EXPECT_EQ(places, (std::vector<uint32_t>{73, 74, 83, 84}));
}

TEST(DefaultRule, EveryPixelGetsTheMinimumFirst) {
    const RenderSettings s = adaptiveSettings(4, 4);
    const auto pass = next(s, Film(4, 4));
    ASSERT_EQ(pass.size(), 16u);
    EXPECT_EQ(pass[0].samples, SamplingPlan::kMinimumSamples);
}

TEST(DefaultRule, ConstantAndBlackPixelsFinish) {
    const RenderSettings s = adaptiveSettings(4, 4);
    EXPECT_TRUE(next(s, filmOf(s, pixel(64, 0.5, 0))).empty());
    EXPECT_TRUE(next(s, filmOf(s, pixel(64, 0, 0))).empty());
}

TEST(DefaultRule, StopsExactlyAtTheTolerance) {
    const RenderSettings s = adaptiveSettings(4, 4);
    // 1.96 sigma / sqrt(n) = tolerance * mean at sigma = 0.05 * 0.5 * sqrt(100) / 1.96.
    const double sigma = 0.05 * 0.5 * 10 / 1.96;
    EXPECT_TRUE(next(s, filmOf(s, pixel(100, 0.5, sigma * 0.999))).empty());
    const auto pass = next(s, filmOf(s, pixel(100, 0.5, sigma * 1.001)));
    ASSERT_EQ(pass.size(), 16u);
    EXPECT_EQ(pass[0].samples, 132u);
}

TEST(DefaultRule, NoisyPixelKeepsItsNeighbourhoodGoing) {
    const RenderSettings s = adaptiveSettings(9, 9);
    Film film = filmOf(s, pixel(100, 0.5, 0));
    film.at(4, 4) = pixel(100, 0.5, 5);
    const auto pass = next(s, film);
    EXPECT_TRUE(wants(pass, 4 * 9 + 4));
    EXPECT_TRUE(wants(pass, 3 * 9 + 3));
    EXPECT_FALSE(wants(pass, 0));
}

TEST(DefaultRule, BlackPixelBesideLitOnesIsNotFinished) {
    const RenderSettings s = adaptiveSettings(9, 9);
    Film film = filmOf(s, pixel(64, 0, 0));
    film.at(4, 4) = pixel(64, 0.05, 0.4); // met a rare light once or twice
    const auto pass = next(s, film);
    for (uint32_t y = 3; y <= 5; ++y)
        for (uint32_t x = 3; x <= 5; ++x)
            EXPECT_TRUE(wants(pass, y * 9 + x));
}

TEST(DefaultRule, NeverPassesTheMostSamples) {
    RenderSettings s = adaptiveSettings(2, 2);
    s.budget.mostSamplesPerPixel = 80;
    const auto first = next(s, filmOf(s, pixel(64, 0.5, 10)));
    ASSERT_EQ(first.size(), 4u);
    EXPECT_EQ(first[0].samples, 80u);
    EXPECT_TRUE(next(s, filmOf(s, pixel(80, 0.5, 10))).empty());
}

TEST(Cs184Rule, TestsEachChannelAtEveryBatch) {
    RenderSettings s = adaptiveSettings(1, 1);
    s.budget.adaptive.rule = Adaptive::Rule::PerChannel;
    EXPECT_EQ(next(s, Film(1, 1))[0].samples, 32u);
    const double sigma = 0.05 * 0.5 * std::sqrt(32.0) / 1.96;
    PixelStatistics p = pixel(32, 0.5, sigma * 0.999);
    Film film(1, 1);
    film.pixels[0] = p;
    EXPECT_TRUE(next(s, film).empty());
    film.pixels[0].m2.z *= 1.01; // only blue fails
    ASSERT_EQ(next(s, film).size(), 1u);
    EXPECT_EQ(next(s, film)[0].samples, 64u);
}

TEST(Cs184Rule, StopsAnAllBlackPixelForEver) {
    RenderSettings s = adaptiveSettings(1, 1);
    s.budget.adaptive.rule = Adaptive::Rule::PerChannel;
    EXPECT_TRUE(next(s, filmOf(s, pixel(32, 0, 0))).empty());
}

} // namespace
} // namespace stromboli
