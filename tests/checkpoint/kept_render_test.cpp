// Renders that keep checkpoints, and devices that are lost, with samples that need no renderer.
#include "host/checkpoint/kept_render.hpp"
#include "host/core/error.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/render/drawn_samples.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

/// Loses its device when it is asked for progress for the n-th time.
class FrailBackend final : public DrawnBackend {
  public:
    explicit FrailBackend(int lives) : DrawnBackend(uneven, 1), lives_(lives) {}
    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override {
        DrawnBackend::sample(targets, film, [&](uint64_t done) {
            if (lives_-- == 0) throw DeviceLostError("Vulkan: cannot run the path kernel: lost");
            return progress(done);
        });
    }

  private:
    int lives_;
};

constexpr int kForEver = 1 << 30;

struct Told {
    std::vector<std::string> lines;
    void operator()(const std::string& line) { lines.push_back(line); }
};

/// A new backend each time, with as many lives as come next.
KeptOutcome run(const KeptRender& render, std::vector<int> lives, Told* told = nullptr,
                const ProgressCallback& progress = {}) {
    size_t next = 0;
    return renderKept(
        render,
        [&](const RenderSettings&, bool again) -> std::unique_ptr<Backend> {
            EXPECT_EQ(again, next > 0);
            return std::make_unique<FrailBackend>(lives.at(next++));
        },
        progress,
        [&](const std::string& line) {
            if (told) (*told)(line);
        });
}

KeptRender spreadRender(const std::filesystem::path& file) {
    KeptRender r;
    r.identity = [] { return RenderIdentity{"program", "code", "scene", 1, "drawn", "none"}; };
    r.settings = settingsOf(kMostSamples);
    r.settings.budget.meanSamplesPerPixel = 64;
    r.file = file;
    r.everySeconds = 1e-9; // at every report of progress
    return r;
}

bool sameFilms(const Film& a, const Film& b) {
    if (a.pixels.size() != b.pixels.size()) return false;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const PixelStatistics &p = a.pixels[i], &q = b.pixels[i];
        if (p.count != q.count || std::memcmp(&p.mean, &q.mean, sizeof p.mean) != 0 ||
            std::memcmp(&p.m2, &q.m2, sizeof p.m2) != 0)
            return false;
    }
    return true;
}

Film undisturbed() {
    return run(spreadRender(""), {kForEver}).film;
}

/// It costs a reading of the whole scene.
TEST(KeptRender, IsIdentifiedOnceAndOnlyForACheckpoint) {
    const TemporaryFolder folder;
    int asked = 0;
    KeptRender render = spreadRender(folder / "c");
    render.identity = [&] {
        ++asked;
        return RenderIdentity{};
    };
    run(render, {kForEver});
    EXPECT_EQ(asked, 1);
    render.everySeconds = 1e9;
    run(render, {kForEver});
    EXPECT_EQ(asked, 1);
}

TEST(KeptRender, CheckpointsDoNotShowInThePicture) {
    const TemporaryFolder folder;
    const KeptOutcome kept = run(spreadRender(folder / "c"), {kForEver});
    EXPECT_TRUE(sameFilms(kept.film, undisturbed()));
    EXPECT_FALSE(kept.stopped);
    EXPECT_EQ(folder.size(), 0u); // it is finished
    EXPECT_FALSE(kept.fileIsThere);
}

TEST(KeptRender, IsKeptAtTheEndWhereThatIsAskedFor) {
    const TemporaryFolder folder;
    KeptRender render = spreadRender(folder / "c");
    render.keepsAtEnd = true;
    render.everySeconds = 1e9;
    const KeptOutcome kept = run(render, {kForEver});
    EXPECT_TRUE(kept.fileIsThere);
    KeptRender more = render;
    more.begun = readCheckpoint(folder / "c").state;
    const auto before = std::filesystem::last_write_time(folder / "c");
    EXPECT_TRUE(sameFilms(run(more, {kForEver}).film, kept.film)); // nothing is left to do
    EXPECT_EQ(std::filesystem::last_write_time(folder / "c"), before);
}

TEST(KeptRender, StoppedAnywhereItGoesOnToTheSameBytes) {
    const TemporaryFolder folder;
    const Film whole = undisturbed();
    KeptRender render = spreadRender(folder / "c");
    render.everySeconds = 1e9;
    int pieces = 0;
    for (;; ++pieces) {
        int left = 3;
        const KeptOutcome kept =
            run(render, {kForEver}, nullptr, [&](const RenderProgress&) { return --left > 0; });
        if (!kept.stopped) {
            EXPECT_TRUE(sameFilms(kept.film, whole));
            break;
        }
        EXPECT_TRUE(kept.fileIsThere);
        render.begun = readCheckpoint(folder / "c").state;
    }
    EXPECT_GT(pieces, 5);
    EXPECT_EQ(folder.size(), 0u);
}

TEST(KeptRender, ALostDeviceCostsNothing) {
    for (const int lives : {0, 1, 5, 20}) {
        const TemporaryFolder folder;
        Told told;
        const KeptOutcome kept = run(spreadRender(folder / "c"), {lives, kForEver}, &told);
        EXPECT_TRUE(sameFilms(kept.film, undisturbed())) << lives;
        EXPECT_FALSE(kept.lost);
        ASSERT_EQ(told.lines.size(), 1u);
        EXPECT_THAT(told.lines[0], HasSubstr(lives == 0 ? "once more, from the beginning"
                                                        : "once more, from the last checkpoint"));
    }
}

TEST(KeptRender, LostTwiceTheFilmSoFarIsThere) {
    const TemporaryFolder folder;
    const KeptOutcome kept = run(spreadRender(folder / "c"), {5, 9});
    ASSERT_TRUE(kept.lost);
    EXPECT_THAT(*kept.lost, HasSubstr("lost"));
    EXPECT_GT(samplesOf(kept.film), 0u);
    EXPECT_TRUE(kept.fileIsThere);
    KeptRender again = spreadRender(folder / "c");
    again.begun = readCheckpoint(folder / "c").state;
    EXPECT_TRUE(sameFilms(run(again, {kForEver}).film, undisturbed()));
}

TEST(KeptRender, LostTwiceWithoutAFile) {
    const KeptOutcome kept = run(spreadRender(""), {5, 9});
    EXPECT_TRUE(kept.lost);
    EXPECT_FALSE(kept.fileIsThere);
}

/// A disk that fills costs the checkpoint, not the render.
TEST(KeptRender, ACheckpointThatCannotBeWrittenIsSaid) {
    const TemporaryFolder folder;
    Told told;
    KeptRender render = spreadRender(folder / "no folder/c");
    const KeptOutcome kept = run(render, {kForEver}, &told);
    EXPECT_TRUE(sameFilms(kept.film, undisturbed()));
    ASSERT_FALSE(told.lines.empty());
    EXPECT_THAT(told.lines[0], HasSubstr("no checkpoint: "));
    EXPECT_FALSE(kept.fileIsThere);
}

} // namespace
} // namespace stromboli
