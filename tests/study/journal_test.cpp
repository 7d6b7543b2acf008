#include "host/core/error.hpp"
#include "host/study/journal.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/study/synthetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace stromboli::study {
namespace {

Study withoutRuns(Study study) {
    for (SceneStudy& scene : study.scenes)
        scene.runs.clear();
    return study;
}

TEST(StudyJournal, RunsComeBackAsTheyWere) {
    const TemporaryFolder folder;
    Study study = powerLawStudy(2, 1e-3);
    study.scenes[0].runs[0].points[0].noise = {PictureNoise::Unknown::No, 0.5, 0.25, 0.75};
    std::ofstream(folder.path() / "study.json") << toJson(study).dump();
    Study next = withoutRuns(study);
    EXPECT_EQ(takeOver(folder / "study.json", next), 6u);
    EXPECT_EQ(toJson(next).dump(), toJson(study).dump());
}

TEST(StudyJournal, OnlyRunsThatFitAreTakenOver) {
    const TemporaryFolder folder;
    const Study study = powerLawStudy(2, 1e-3);
    std::ofstream(folder.path() / "study.json") << toJson(study).dump();
    const auto taken = [&](auto change) {
        Study next = withoutRuns(study);
        change(next);
        return takeOver(folder / "study.json", next);
    };
    EXPECT_EQ(taken([](Study& s) { s.key = "another program"; }), 0u);
    EXPECT_EQ(taken([](Study& s) { s.scenes[0].content = "another file"; }), 0u);
    EXPECT_EQ(taken([](Study& s) { s.settings.seeds = 1; }), 3u);
    EXPECT_EQ(taken([](Study& s) { s.settings.seeds = 9; }), 6u);
    EXPECT_EQ(taken([](Study& s) { s.settings.configurations[0].options = "-l 2"; }), 4u);
    EXPECT_EQ(taken([](Study& s) { s.settings.configurations.pop_back(); }), 4u);
    EXPECT_EQ(taken([](Study& s) { s.settings.sampleCounts = {4, 16, 64}; }), 0u);
}

TEST(StudyJournal, WhatIsNoStudyIsNotOverwritten) {
    const TemporaryFolder folder;
    Study study = powerLawStudy(1, 0);
    EXPECT_EQ(takeOver(folder / "none.json", study), 0u);
    for (const char* text : {"", "[]", "{\"format\": \"other\"}", "hello"}) {
        std::ofstream(folder.path() / "study.json") << text;
        EXPECT_THROW(takeOver(folder / "study.json", study), OutputError) << text;
    }
}

TEST(StudyJournal, CsvHasALineForEveryPicture) {
    const std::string csv = toCsv(powerLawStudy(2, 0));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 3 * 4);
    EXPECT_THAT(csv, testing::HasSubstr("\ns,hemisphere,2,16,16,0.8,1.6,0.5,0,"));
    const auto head = csv.substr(0, csv.find('\n'));
    const auto line =
        csv.substr(head.size() + 1, csv.find('\n', head.size() + 1) - head.size() - 1);
    EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(line.begin(), line.end(), ','));
}

TEST(StudyJournal, TableSaysRatiosAndSlopes) {
    const std::string text = toText(powerLawStudy(2, 1e-9));
    EXPECT_THAT(text, testing::HasSubstr("hemisphere"));
    EXPECT_THAT(text, testing::HasSubstr("-1.50"));
    EXPECT_THAT(text, testing::HasSubstr("4.00 (4.00..4.00)"));
}

TEST(StudyJournal, TableSaysHowOftenAStatedNoiseWasTrue) {
    Study study = powerLawStudy(2, 0);
    EXPECT_THAT(toText(study), testing::Not(testing::HasSubstr("stated noise")));
    Point& a = study.scenes[0].runs[0].points[0]; // one is right, one is half of the truth
    Point& b = study.scenes[0].runs[3].points[0];
    ASSERT_EQ(study.scenes[0].runs[3].configuration, study.scenes[0].runs[0].configuration);
    for (Point* p : {&a, &b})
        p->noise = {PictureNoise::Unknown::No, std::sqrt(p->relMse), 0.9 * std::sqrt(p->relMse),
                    1.1 * std::sqrt(p->relMse)};
    b.relMse *= 4;
    EXPECT_THAT(toText(study), testing::ContainsRegex("default +4 +2 +2 +1 +0.71"));
}

TEST(StudyJournal, JsonHoldsRatiosOfEveryPair) {
    const auto json = nlohmann::json::parse(toJson(powerLawStudy(2, 1e-9)).dump());
    const auto& ratios = json["scenes"][0]["summary"]["ratios"]["wall"];
    EXPECT_EQ(ratios.size(), 6u);
    for (const auto& r : ratios)
        if (r["of"] == "default" && r["to"] == "bsdf") {
            EXPECT_NEAR(r["time"]["value"].get<double>(), 4, 1e-4);
            EXPECT_NEAR(r["error"]["value"].get<double>(), 8, 1e-4);
        }
}

} // namespace
} // namespace stromboli::study
