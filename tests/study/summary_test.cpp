// Figures of measurements that follow known laws.
#include "host/study/summary.hpp"
#include "tests/study/synthetic.hpp"

#include <gtest/gtest.h>

namespace stromboli::study {
namespace {

TEST(StudySummary, OfPowerLaws) {
    const Study study = powerLawStudy(2, 1e-9);
    const SceneSummary s = summarise(study.scenes[0], study.settings);
    ASSERT_EQ(s.configurations.size(), 3u);
    const auto &base = s.configurations[0], &hemisphere = s.configurations[1],
               &steep = s.configurations[2];
    EXPECT_NEAR(s.targetError, 1.0 / 64, 1e-9);
    EXPECT_NEAR(*base.wall.timeToTarget, 6.4, 1e-5);
    EXPECT_NEAR(*base.cpu.timeToTarget, 12.8, 1e-5);
    EXPECT_NEAR(*base.wall.efficiency, 64 / 6.4, 1e-4);
    // Eight times the error at half the time a sample.
    EXPECT_NEAR(timeRatio(base, hemisphere, Clock::Wall)->value, 0.25, 1e-6);
    EXPECT_NEAR(errorRatio(base, hemisphere, Clock::Cpu)->value, 0.25, 1e-6);
    // n^-1.5 is 1/64 at 16 samples, and 64^-1.5 at the baseline's time.
    EXPECT_NEAR(timeRatio(base, steep, Clock::Wall)->value, 4, 1e-4);
    EXPECT_NEAR(errorRatio(base, steep, Clock::Wall)->value, 8, 1e-4);
    EXPECT_NEAR(steep.slope->value, -1.5, 1e-6);
    EXPECT_NEAR(base.slope->value, -1, 1e-6);
    EXPECT_FALSE(base.wall.extrapolated);
}

TEST(StudySummary, TheReferencesOwnErrorIsTakenAway) {
    Study study = powerLawStudy(2, 1.0 / 128);
    for (auto& run : study.scenes[0].runs) // where the reference decides, anything may come out
        run.points[3].relMse *= 1.1;
    const SceneSummary s = summarise(study.scenes[0], study.settings);
    // 1/256 is below the reference's error: that point is shown, and not used.
    EXPECT_TRUE(s.configurations[0].points[3].limitedByReference);
    EXPECT_FALSE(s.configurations[0].points[2].limitedByReference);
    EXPECT_NEAR(s.configurations[0].points[2].relMse.value, 1.0 / 64, 1e-12);
    EXPECT_NEAR(s.configurations[0].slope->value, -1, 1e-9);
    EXPECT_NEAR(s.targetError, 1.0 / 64, 1e-12);
}

TEST(StudySummary, TimesBeyondTheMeasuredAreMarked) {
    Study study = powerLawStudy(1, 0);
    study.scenes[0].runs[1].points.pop_back(); // hemisphere needs 512 samples
    const SceneSummary s = summarise(study.scenes[0], study.settings);
    EXPECT_TRUE(s.configurations[1].wall.extrapolated);
    EXPECT_NEAR(*s.configurations[1].wall.timeToTarget, 512 * 0.05, 1e-6);
}

TEST(StudySummary, BiasOverSeedsHoldsTheReferencesUncertainty) {
    const Study study = powerLawStudy(2, 0);
    const Estimate bias = summarise(study.scenes[0], study.settings).configurations[0].bias;
    EXPECT_NEAR(bias.value, 0.02, 1e-12); // of 0.01 and 0.03, standard error 0.01
    const double half = std::hypot(tQuantile(1) * 0.01, 1.96 * 0.001);
    EXPECT_NEAR(bias.interval->second, 0.02 + half, 1e-9);
}

TEST(StudySummary, WithoutABaselinesRunsThereAreNoRatios) {
    Study study = powerLawStudy(1, 0);
    std::erase_if(study.scenes[0].runs, [](const auto& r) { return r.configuration == "default"; });
    const SceneSummary s = summarise(study.scenes[0], study.settings);
    ASSERT_EQ(s.configurations.size(), 2u);
    EXPECT_EQ(s.targetError, 0);
    EXPECT_FALSE(s.configurations[0].wall.timeToTarget);
    EXPECT_FALSE(timeRatio(s.configurations[0], s.configurations[1], Clock::Wall));
}

} // namespace
} // namespace stromboli::study
