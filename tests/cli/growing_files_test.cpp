// Checkpoints and films of renders that go on meanwhile.
#include "host/core/system.hpp"
#include "host/film/image_formats.hpp"
#include "tests/cli/film_folder.hpp"
#include "tests/cli/running_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <thread>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class GrowingFiles : public FilmFolder {
  protected:
    std::string scene = libraryScene("cornell_spheres.dae");

    Strings render(const std::string& output, const Strings& extra) const {
        return Strings{"render", scene, "-o", folder.file(output), "-r", "24", "18"} + extra;
    }
    /// What `info` says of a file as JSON: its first object.
    nlohmann::json infoOf(const std::string& file) const {
        const ProgramRun run = stromboli({"info", file, "--json", "-"});
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return nlohmann::json::parse(run.out).at(0);
    }
};

/// While a render replaces its checkpoint again and again, each reading is of a whole one, with at
/// least as many samples as the one before. When it is stopped, the picture of the checkpoint is
/// the one that the render writes.
TEST_F(GrowingFiles, CheckpointsOfARunningRenderAreReadWhole) {
    for (const Strings& how : {Strings{}, Strings{"--even", "--block", "8"},
                               Strings{"--backend", "reference", "--even"}}) {
        const std::string kept = folder.file("kept");
        std::filesystem::remove(kept);
        RunningProgram program(render("a.exr", how + Strings{"-s", "1M", "--checkpoint", kept,
                                                             "--checkpoint-every", "0.01"}));
        const Stopwatch watch;
        while (!std::filesystem::exists(kept) && !program.hasEnded() && watch.seconds() < kSoon)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        ASSERT_TRUE(std::filesystem::exists(kept)) << program.finish(kSoon).err;
        std::set<double> seen;
        double last = 0;
        // Until the render has done more work three times.
        for (int readings = 0; seen.size() < 4 && readings < 1000; ++readings) {
            const auto info = infoOf(kept);
            EXPECT_TRUE(info.at("isComplete"));
            EXPECT_EQ(info.at("width"), 24);
            EXPECT_GE(info.at("samples"), last);
            EXPECT_EQ(info.at("samplesAtMost"), 1e6);
            last = info.at("samples");
            seen.insert(last);
            const ProgramRun merged = merge("now.exr", {kept});
            ASSERT_EQ(merged.exitCode, 0) << merged.err;
            EXPECT_THAT(merged.err, HasSubstr("a pixel of at most 1e+06"));
            EXPECT_EQ(readExr(folder.path() / "now.exr").width, 24u);
        }
        EXPECT_EQ(seen.size(), 4u);
        program.send(SIGINT);
        EXPECT_EQ(program.finish(kSoon).exitCode, 128 + SIGINT);
        EXPECT_EQ(merge("now.exr", {kept}).exitCode, 0);
        EXPECT_EQ(readExr(folder.path() / "now.exr").channels,
                  readExr(folder.path() / "a.exr").channels);
        const ProgramRun whole = merge("now.exr", {kept}, {"--complete"});
        EXPECT_EQ(whole.exitCode, 1);
        EXPECT_THAT(whole.err, HasSubstr("the render is not finished"));
        EXPECT_EQ(merge("now.film", {kept}).exitCode, 1);
        EXPECT_EQ(merge("now.exr", {kept, kept}).exitCode, 1);
    }
    const ProgramRun none = stromboli({"info", folder.file("b.exr.checkpoint")});
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.err, HasSubstr("or the render is finished"));
}

/// A checkpoint that is kept at the end, too, and what is missing from the picture.
TEST_F(GrowingFiles, FinishedRendersAreSaidToBe) {
    const std::string kept = folder.file("kept");
    for (const Strings& how : {Strings{"-s", "4", "--even"}, Strings{"-s", "20"},
                               Strings{"--noise", "0.5", "-s", "1k"}}) {
        run(render("a.exr", how + Strings{"-q", "--checkpoint", kept}));
        const ProgramRun merged = merge("now.exr", {kept}, {"--complete"});
        EXPECT_EQ(merged.exitCode, 0) << merged.err;
        EXPECT_THAT(merged.err, Not(HasSubstr("not finished")));
        EXPECT_THAT(merged.err, Not(HasSubstr("behind objects")));
    }
    for (const Strings& how :
         {Strings{"--transparent"}, Strings{"--background", "1"}, Strings{"--shadow-catcher"}}) {
        run(render("a.exr", how + Strings{"-q", "-s", "2", "--checkpoint", kept}));
        EXPECT_THAT(merge("now.exr", {kept}).err, HasSubstr("what is seen behind objects: alpha, "
                                                            "--background and shadows"));
    }
}

/// The checkpoints of bands, under the name that the picture's would have.
TEST_F(GrowingFiles, BandsAreOnePicture) {
    const std::string kept = folder.file("kept");
    run({"render", scene, "-o", folder.file("a.exr"), "-r", "120", "90", "-s", "4", "--even", "-q",
         "--film-memory", "1", "--checkpoint", kept});
    ASSERT_FALSE(std::filesystem::exists(kept));
    const ProgramRun all = merge("now.exr", {kept}, {"--complete"});
    ASSERT_EQ(all.exitCode, 0) << all.err;
    EXPECT_EQ(readExr(folder.path() / "now.exr").channels,
              readExr(folder.path() / "a.exr").channels);
    std::set<std::string> bands;
    for (const std::string& name : folder.entries())
        if (name.starts_with("kept.band")) bands.insert(name);
    ASSERT_GT(bands.size(), 1u);
    std::filesystem::remove(folder.path() / *bands.rbegin());
    const ProgramRun some = merge("now.exr", {kept});
    EXPECT_EQ(some.exitCode, 0) << some.err;
    EXPECT_THAT(some.err, HasSubstr("the render is not finished"));
    const FloatImage picture = readExr(folder.path() / "now.exr");
    EXPECT_EQ(picture.height, 90u);
    EXPECT_EQ(picture.channels.at("G").back(), 0);
    EXPECT_EQ(merge("now.exr", {kept}, {"--complete"}).exitCode, 1);
    EXPECT_EQ(merge("now.exr", {kept, kept}).exitCode, 1);
}

/// A film that somebody copies under its name is left out, with a line that says how far it is and
/// an exit code for scripts: it may have been cut short for good.
TEST_F(GrowingFiles, FilmsThatAreHalfThereAreLeftOut) {
    for (const char* share : {"1/2", "2/2"})
        run(render(std::string("part") + share[0] + ".film",
                   {"-s", "32", "--block", "8", "-q", "--share", share}));
    const std::string first = folder.file("part1.film"), second = folder.file("part2.film");
    EXPECT_EQ(infoOf(first).at("samples"), 16);
    EXPECT_EQ(infoOf(first).at("samplesAtMost"), 32);
    EXPECT_THAT(infoOf(first).at("missing").get<std::string>(), HasSubstr("share 2 of 2"));
    ASSERT_EQ(merge("first.exr", {first}).exitCode, 0);
    ASSERT_EQ(merge("both.exr", {first, second}).exitCode, 0);
    const std::string whole = bytesOf("part2.film");
    for (const size_t size :
         {size_t(0), size_t(10), size_t(60), whole.size() / 2, whole.size() - 1}) {
        std::ofstream(second, std::ios::binary) << whole.substr(0, size);
        const ProgramRun run = merge("now.exr", {second, first});
        EXPECT_EQ(run.exitCode, 6) << run.err;
        EXPECT_THAT(run.err, HasSubstr("part2.film is still being written"));
        EXPECT_THAT(run.err, HasSubstr("now.exr lacks 1 of 2 films"));
        EXPECT_TRUE(bytesOf("now.exr") == bytesOf("first.exr")) << size;
        EXPECT_EQ(merge("now.exr", {first, second}, {"--complete"}).exitCode, 1);
        EXPECT_EQ(merge("now.exr", {second}).exitCode, 1);
        EXPECT_FALSE(infoOf(second).at("isComplete"));
    }
    EXPECT_THAT(stromboli({"info", second}).out, HasSubstr("18 of 18 rows are complete"));
    std::ofstream(second, std::ios::binary) << whole;
    ASSERT_EQ(merge("now.exr", {first, second}).exitCode, 0);
    EXPECT_TRUE(bytesOf("now.exr") == bytesOf("both.exr"));
    // What is damaged is no film that grows.
    std::string damaged = whole;
    damaged[damaged.size() / 2] ^= 1;
    std::ofstream(second, std::ios::binary) << damaged;
    EXPECT_EQ(merge("now.exr", {first, second}).exitCode, 1);
}

/// A limit of light is part of what a render is of.
TEST_F(GrowingFiles, AnotherLimitOfLightIsAnotherRender) {
    const Strings kept = {"-q", "--checkpoint", folder.file("kept")};
    run(render("a.exr", kept + Strings{"-s", "2", "--clamp-indirect", "1"}));
    const ProgramRun other =
        stromboli(render("a.exr", kept + Strings{"-s", "4", "--resume", "--clamp-indirect", "2"}));
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_THAT(other.err, HasSubstr("other settings"));
    run(render("b.exr", {"-q", "-s", "2", "--even"}));
    const ProgramRun biased = stromboli(
        render("c.exr", {"-s", "2", "--even", "--clamp-indirect", "1e-3", "--stats", "-"}));
    EXPECT_THAT(biased.err, HasSubstr("the picture is biased"));
    EXPECT_THAT(biased.out, HasSubstr("\"clampIndirect\": 0.001"));
    const auto sumOf = [&](const char* name) {
        const FloatImage picture = readExr(folder.path() / name);
        double sum = 0;
        for (const float v : picture.channels.at("G"))
            sum += double(v);
        return sum;
    };
    EXPECT_LT(sumOf("c.exr"), 0.9 * sumOf("b.exr"));
    run(render("c.film",
               {"-q", "-s", "2", "--block", "2", "--clamp-indirect", "1", "--share", "1/1"}));
    EXPECT_THAT(merge("d.exr", {folder.file("c.film")}).err, HasSubstr("the picture is biased"));
    EXPECT_THAT(
        stromboli(render("d.exr", {"-s", "1", "--clamp-indirect", "1", "--integrator", "normals"}))
            .err,
        HasSubstr("follows no light: ignored: --clamp-indirect"));
}

} // namespace
} // namespace stromboli::test
