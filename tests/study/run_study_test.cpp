// The measuring itself, with a backend whose noise is known: sample values are 1 plus noise of
// a stated variance, so relMSE is variance / n / 1.01 (the picture's mean is 1).
#include "host/study/journal.hpp"
#include "host/study/run_study.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace stromboli::study {
namespace {

class NoiseBackend final : public Backend {
  public:
    /// `share`: of the noise that all but the upper quarter has.
    NoiseBackend(double sigma, double share, uint32_t seed)
        : sigma_(sigma), share_(share), seed_(seed) {}

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override {
        const uint64_t before = paths_;
        for (const PixelTarget& t : targets)
            for (uint32_t i = film.pixels[t.pixel].taken(); i < t.samples; ++i)
                film.pixels[t.pixel].add(sampleAlone(t.pixel, i).radiance), ++paths_;
        progress(paths_ - before);
    }
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override {
        // Steele, Lea and Flood 2014 (SplitMix), its state a different one for each sample.
        uint64_t x = (uint64_t(seed_) << 40) + (uint64_t(pixel) << 16) + sample;
        x = (x + 0x9E3779B97F4A7C15u) * 0xBF58476D1CE4E5B9u;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
        x ^= x >> 31;
        const double noise = double(x >> 11) * 0x1p-52 - 1; // in [-1, 1)
        const double sigma = sigma_ * (pixel / (24 * 5) ? share_ : 1);
        return {glm::dvec3(1 + sigma * std::sqrt(3.0) * noise), false}; // variance sigma^2
    }
    RenderCounters counters() const override { return {paths_, 2 * paths_}; }

  private:
    double sigma_, share_;
    uint32_t seed_;
    uint64_t paths_ = 0;
};

/// Understands "--seed", "-s", "-a", "--spread" and, for a configuration of more noise, "-l 4".
struct FakeRenderer {
    int prepared = 0;
    std::vector<std::vector<std::string>> lines;

    PreparedRender operator()(const std::string&, const std::vector<std::string>& words) {
        ++prepared;
        lines.push_back(words);
        const auto after = [&](const char* name) {
            const auto at = std::find(words.begin(), words.end(), name);
            return at == words.end() ? 0u : uint32_t(std::stoul(*(at + 1)));
        };
        PreparedRender render;
        render.settings.area.width = 24;
        render.settings.area.height = 20;
        render.settings.budget.mostSamplesPerPixel = after("-s");
        if (const auto at = std::find(words.begin(), words.end(), "-a"); at != words.end()) {
            render.settings.budget.adaptive.enabled = true;
            render.settings.budget.adaptive.batch = uint32_t(std::stoul(*(at + 1)));
            render.settings.budget.adaptive.tolerance = std::stod(*(at + 2));
        }
        const bool spread = std::find(words.begin(), words.end(), "--spread") != words.end();
        if (spread) {
            render.settings.budget.meanSamplesPerPixel = after("-s");
            render.settings.budget.mostSamplesPerPixel = 1u << 20;
        }
        render.backend = std::make_unique<NoiseBackend>(after("-l") ? 0.5 : 0.25, spread ? 0.02 : 1,
                                                        after("--seed"));
        return render;
    }
};

Study newStudy(const std::vector<std::string>& configurations) {
    Study study;
    study.key = "test";
    study.settings.configurations = chooseConfigurations(configurations);
    study.settings.commonOptions = "-m 5";
    study.settings.sampleCounts = {4, 16, 64};
    study.settings.seeds = 3;
    study.settings.referenceSamples = 512;
    study.settings.baseline = "default";
    study.scenes = {{.name = "scene"}};
    return study;
}

StudyHooks hooksOf(
    FakeRenderer& renderer, std::function<bool()> stopped = [] { return false; }) {
    return {[&](const std::string& scene, const std::vector<std::string>& words) {
                return renderer(scene, words);
            },
            [](const StudyProgress&) {}, stopped};
}

TEST(RunStudy, FindsTheNoiseThatWasPutIn) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    Study study = newStudy({"default", "loud=-l 4"});
    ASSERT_TRUE(runStudy(folder.path(), study, hooksOf(renderer)));
    const SceneStudy& scene = study.scenes[0];
    EXPECT_EQ(scene.runs.size(), 6u);
    // 24 x 20 pixels whose squares have a relative deviation below 1.5 (nearly normal means, all
    // channels equal), three seeds: standard error 1.5 / sqrt(1440) = 4 %; limits at 5 of these.
    const double perSample = 0.25 * 0.25 / 1.01;
    EXPECT_NEAR(scene.reference.relMse, perSample / 512, 0.2 * perSample / 512);
    const SceneSummary s = summarise(scene, study.settings);
    for (const auto& c : s.configurations) {
        const double variance = c.name == "loud" ? 4 * perSample : perSample;
        for (const SummaryPoint& p : c.points)
            EXPECT_NEAR(p.relMse.value, variance / p.samples, 0.2 * variance / p.samples);
        EXPECT_NEAR(c.slope->value, -1, 0.1);
        EXPECT_NEAR(c.bias.value, 0,
                    5 * std::sqrt(variance / 64 / 1440) + 5 * 0.25 / std::sqrt(512 * 480));
    }
}

TEST(RunStudy, RendersSpreadSamplesAnewForEachCount) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    Study study = newStudy({"default", "mine=--spread"});
    study.settings.seeds = 1;
    ASSERT_TRUE(runStudy(folder.path(), study, hooksOf(renderer)));
    const std::vector<uint32_t>& counts = study.settings.sampleCounts;
    for (const uint32_t count : counts)
        EXPECT_TRUE(std::find(renderer.lines.begin(), renderer.lines.end(),
                              std::vector<std::string>{"-m", "5", "--spread", "--seed", "1", "-s",
                                                       std::to_string(count)}) !=
                    renderer.lines.end());
    const auto& runs = study.scenes.at(0).runs;
    const auto run = std::find_if(runs.begin(), runs.end(),
                                  [](const auto& r) { return r.configuration == "mine"; });
    ASSERT_NE(run, runs.end());
    ASSERT_EQ(run->points.size(), counts.size());
    for (size_t i = 0; i < counts.size(); ++i) {
        EXPECT_EQ(run->points[i].effort, counts[i]);
        EXPECT_LE(run->points[i].samples, counts[i]);
        EXPECT_GT(run->points[i].samples, 0.9 * counts[i]);
    }
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "pictures/scene-mine-2-samples.png"));
}

TEST(RunStudy, RendersWithTheOptionsOfTheConfiguration) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    Study study = newStudy({"default", "loud=-l 4", "mine=-a 4 {0.9,0.5}"});
    study.settings.seeds = 1;
    ASSERT_TRUE(runStudy(folder.path(), study, hooksOf(renderer)));
    const auto has = [&](const std::vector<std::string>& line) {
        return std::find(renderer.lines.begin(), renderer.lines.end(), line) !=
               renderer.lines.end();
    };
    ASSERT_EQ(renderer.lines.size(), 5u); // reference, two runs, and one for each tolerance
    EXPECT_TRUE(has({"-m", "5", "--seed", std::to_string(kReferenceSeed), "--even", "-s", "512"}));
    EXPECT_TRUE(has({"-m", "5", "--seed", "1", "-s", "64"}));
    EXPECT_TRUE(has({"-m", "5", "-l", "4", "--seed", "1", "-s", "64"}));
    EXPECT_TRUE(has({"-m", "5", "-a", "4", "0.9", "--seed", "1", "-s", "1024"}));
    const auto& points = study.scenes[0].runs.back().points;
    EXPECT_EQ(points[0].effort, 0.9);
    EXPECT_EQ(points[0].samples, 64); // what every pixel gets before the first test
    EXPECT_EQ(points[0].rays, uint64_t(2 * 64 * 24 * 20));
}

TEST(RunStudy, AStoppedStudyGoesOnWhereItWas) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    Study first = newStudy({"default", "loud=-l 4"});
    int asked = 0;
    EXPECT_FALSE(runStudy(folder.path(), first, hooksOf(renderer, [&] {
                              return first.scenes[0].runs.size() == 2 && ++asked > 1;
                          })));
    EXPECT_EQ(first.scenes[0].runs.size(), 2u); // the third is thrown away
    const int before = renderer.prepared;

    Study second = newStudy({"default", "loud=-l 4"});
    EXPECT_EQ(takeOver(folder / "study.json", second), 2u);
    EXPECT_TRUE(runStudy(folder.path(), second, hooksOf(renderer)));
    EXPECT_EQ(renderer.prepared - before, 4); // no run again, nor the reference
    EXPECT_EQ(second.scenes[0].runs.size(), 6u);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(second.scenes[0].runs[i].points[0].relMse,
                  first.scenes[0].runs[i].points[0].relMse);
}

TEST(RunStudy, AnotherReferenceIsMadeOnlyIfItHasTo) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    const auto referencesMade = [&](auto change) {
        Study study = newStudy({"default"});
        study.settings.seeds = 1;
        change(study);
        renderer.lines.clear();
        runStudy(folder.path(), study, hooksOf(renderer));
        const std::string seed = std::to_string(kReferenceSeed);
        return std::count_if(renderer.lines.begin(), renderer.lines.end(), [&](const auto& line) {
            return std::find(line.begin(), line.end(), seed) != line.end();
        });
    };
    EXPECT_EQ(referencesMade([](Study&) {}), 1);
    EXPECT_EQ(referencesMade([](Study&) {}), 0);
    EXPECT_EQ(referencesMade([](Study& s) { s.settings.referenceSamples = 256; }), 0);
    EXPECT_EQ(referencesMade([](Study& s) { s.settings.commonOptions = "-m 6"; }), 1);
    EXPECT_EQ(referencesMade([](Study& s) { s.settings.commonOptions = "-m 6"; }), 0);
    EXPECT_EQ(referencesMade([](Study& s) { s.scenes[0].content = "changed"; }), 1);
    EXPECT_EQ(referencesMade([](Study& s) { s.settings.referenceSamples = 1024; }), 1);
}

TEST(RunStudy, PicturesOfTheFirstSeed) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    Study study = newStudy({"default", "mine=-a 4 {0.9,0.02}"});
    ASSERT_TRUE(runStudy(folder.path(), study, hooksOf(renderer)));
    for (const char* name :
         {"scene-default-0.png", "scene-default-2-error.png", "scene-mine-1-samples.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "pictures/scene-default-2-samples.png"));
}

TEST(RunStudy, EffortsThatTakeTooLongAreLeftOut) {
    const TemporaryFolder folder;
    FakeRenderer renderer;
    Study study = newStudy({"default"});
    study.settings.mostSecondsPerRun = 1e-9; // any first effort is let through
    ASSERT_TRUE(runStudy(folder.path(), study, hooksOf(renderer)));
    EXPECT_TRUE(study.scenes[0].runs[0].cutShort);
    EXPECT_EQ(study.scenes[0].runs[0].points.size(), 1u);
    Study again = newStudy({"default"});
    EXPECT_EQ(takeOver(folder / "study.json", again), 3u);
}

} // namespace
} // namespace stromboli::study
