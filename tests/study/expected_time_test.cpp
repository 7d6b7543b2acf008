#include "host/study/measure.hpp"

#include <gtest/gtest.h>

namespace stromboli::study {
namespace {

TEST(StudyExpectedTime, LearnsFromWhatIsDone) {
    Study study;
    study.settings.configurations = chooseConfigurations({"default", "hemisphere"});
    study.settings.seeds = 2;
    study.settings.sampleCounts = {4, 64};
    study.settings.referenceSamples = 640;
    study.scenes = {{.name = "a"}, {.name = "b"}};
    study.scenes[0].runs = {{"default", 1, {}, false}}; // from an earlier session
    ExpectedTime expected(study);
    EXPECT_FALSE(expected.secondsLeft());
    expected.referenceTook(100,
                           100); // ten times a run's samples: 10 s a run, 7 runs, one reference
    EXPECT_DOUBLE_EQ(*expected.secondsLeft(), 7 * 10 + 100);
    expected.runTook("a", "hemisphere", 20); // all other runs are expected to take 20 s as well
    EXPECT_DOUBLE_EQ(*expected.secondsLeft(), 6 * 20 + 100);
    expected.runTook("a", "default", 4); // "a" is done but for hemisphere; "b": the mean, 12 s
    EXPECT_DOUBLE_EQ(*expected.secondsLeft(), 20 + 4 * 12 + 100);
    EXPECT_DOUBLE_EQ(expected.secondsDone(), 124);
}

} // namespace
} // namespace stromboli::study
