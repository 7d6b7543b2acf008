// The program where it was installed.
#include "source_dir.h"
#include "tests/support/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

const std::string kBuild = STROMBOLI_BUILD_DIR;

/// The program in a prefix of its own.
class Install : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder = std::make_unique<EmptyFolder>();
        const ShellRun done =
            shell("cmake --install " + kBuild + " --prefix " + *folder / "prefix");
        ASSERT_EQ(done.exitCode, 0) << done.output;
    }
    static void TearDownTestSuite() { folder.reset(); }

    static std::string in(const std::string& name) { return *folder / ("prefix/" + name); }
    /// What `info` says of a scene, with the file that its name stands for.
    static ShellRun info(const std::string& program, const std::string& scene) {
        return shell("cd /; " + program + " info " + scene + " --json -");
    }

    static std::unique_ptr<EmptyFolder> folder;
};

std::unique_ptr<EmptyFolder> Install::folder;

TEST_F(Install, HasProgramScenesManualCompletionAndDocuments) {
    for (const char* name :
         {"bin/stromboli", "share/stromboli/scenes/cornell_boxes.dae",
          "share/man/man1/stromboli.1.gz", "share/bash-completion/completions/stromboli",
          "share/fish/vendor_completions.d/stromboli.fish",
          "share/zsh/vendor-completions/_stromboli", "share/doc/stromboli/README.md",
          "share/doc/stromboli/docs/hard_cases.md", "share/doc/stromboli/copyright",
          "share/doc/stromboli/changelog.gz"})
        EXPECT_TRUE(fs::is_regular_file(in(name))) << name;
    size_t scenes = 0;
    for (const auto& entry : fs::directory_iterator(in("share/stromboli/scenes")))
        scenes += entry.path().extension() == ".dae" || entry.path().extension() == ".glb" ||
                  entry.path().extension() == ".xml";
    EXPECT_EQ(scenes, 21u);
    for (const char* file : {"evening_sky.hdr", "atrium/stone.ply", "atrium/stone.png"})
        EXPECT_TRUE(fs::is_regular_file(in(std::string("share/stromboli/scenes/") + file))) << file;
    EXPECT_THAT(shell("find " + *folder / "prefix").output, Not(HasSubstr("write_manual")));
}

TEST_F(Install, ScenesAreThoseOfThePrefixWhereverItIs) {
    EXPECT_THAT(info(in("bin/stromboli"), "cornell_boxes").output,
                HasSubstr(in("share/stromboli/scenes/cornell_boxes.dae")));
    // One that the source folder does not have; through a link, and in another place.
    shell("cp -r " + *folder / "prefix" + " " + *folder / "moved");
    shell("cd " + *folder / "moved" + "/share/stromboli/scenes && cp ortho.dae only_here.dae");
    shell("ln -s moved/bin/stromboli " + *folder / "link");
    const std::string there = *folder / "moved/share/stromboli/scenes/only_here.dae";
    for (const char* program : {"moved/bin/stromboli", "link"}) {
        const ShellRun run = info(*folder / program, "only_here");
        EXPECT_EQ(run.exitCode, 0);
        EXPECT_THAT(run.output, HasSubstr(there)) << program;
    }
    EXPECT_EQ(info(in("bin/stromboli"), "only_here").exitCode, 2);
}

TEST_F(Install, WithoutItsFilesItHasTheSceneOfTheSources) {
    shell("cp " + in("bin/stromboli") + " " + *folder / "alone");
    EXPECT_THAT(info(*folder / "alone", "ortho").output,
                HasSubstr(STROMBOLI_SOURCE_DIR "/scene/library/ortho.dae"));
}

} // namespace
} // namespace stromboli::test
