// The program where it was installed, and the Debian package.
#include "source_dir.h"
#include "tests/support/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
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
          "share/doc/stromboli/docs/theory/hard_cases.md", "share/doc/stromboli/copyright",
          "share/doc/stromboli/changelog.gz"})
        EXPECT_TRUE(fs::is_regular_file(in(name))) << name;
    size_t scenes = 0;
    for (const auto& entry : fs::directory_iterator(in("share/stromboli/scenes")))
        scenes += entry.path().extension() == ".dae" || entry.path().extension() == ".glb" ||
                  entry.path().extension() == ".xml";
    EXPECT_EQ(scenes, 17u);
    EXPECT_TRUE(fs::is_regular_file(in("share/stromboli/scenes/evening_sky.hdr")));
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

TEST(Package, SaysWhatItNeedsAndHasThePrograms) {
    for (const char* tool : {"dpkg-deb", "dpkg-shlibdeps", "file"})
        if (!isInstalled(tool)) GTEST_SKIP() << tool << " is not installed";
    const EmptyFolder folder;
    std::ofstream(folder / "stromboli_0.0.1_amd64.deb") << "an earlier one";
    const ShellRun made = shell("cd " + folder.path().string() + " && cpack -G DEB -B . --config " +
                                kBuild + "/CPackConfig.cmake");
    ASSERT_EQ(made.exitCode, 0) << made.output;
    EXPECT_EQ(shell("ls " + folder.path().string() + "/*.deb | wc -l").output, "1\n");
    const std::string file = "cd " + folder.path().string() + "; dpkg-deb ";
    const std::string fields = shell(file + "-f *.deb").output;
    // Linked libraries by their packages; the loader and a driver, which are opened at run time.
    for (const char* needed : {"libtinyxml2-", "libopenexr-", "libzip", "libvulkan1",
                               "mesa-vulkan-drivers | vulkan-icd"})
        EXPECT_THAT(fields, HasSubstr(needed));
    const std::string said = shell(STROMBOLI_PROGRAM " --version").output;
    EXPECT_THAT(fields, HasSubstr("Version: " + said.substr(std::string("stromboli ").size())));
    const std::string content = shell(file + "-c *.deb").output;
    for (const char* name : {"./usr/bin/stromboli\n", "./usr/share/stromboli/scenes/island.dae\n",
                             "./usr/share/man/man1/stromboli.1.gz\n"})
        EXPECT_THAT(content, HasSubstr(name));
}

} // namespace
} // namespace stromboli::test
