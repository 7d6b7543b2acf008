// --device with several devices.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace stromboli::test {
namespace {

using testing::HasSubstr, testing::Not;

class Devices : public testing::Test {
  protected:
    ScratchFolder folder;

    ProgramRun render(const std::string& device, const std::string& picture,
                      const std::string& environment = "",
                      const std::string& scene = "cornell_boxes.dae") {
        return stromboli({"render", libraryScene(scene), "-r", "64", "48", "-s", "32", "--notes",
                          "off", "--device", device, "-o", folder.file(picture)},
                         environment);
    }
    std::string bytes(const std::string& name) {
        std::ifstream file(folder.file(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

TEST_F(Devices, TwoOfAKindMakeTheSameBytes) {
    ASSERT_EQ(render("0", "one.png").exitCode, 0);
    const ProgramRun two = render("0,0", "two.png");
    ASSERT_EQ(two.exitCode, 0) << two.err;
    EXPECT_EQ(bytes("one.png"), bytes("two.png"));
    ASSERT_EQ(render("all", "all.png").exitCode, 0);
    EXPECT_EQ(bytes("one.png"), bytes("all.png"));
}

TEST_F(Devices, DriversOfAbsentGpusAreNotOpened) {
    if (std::filesystem::exists("/dev/dri")) GTEST_SKIP() << "this machine has a GPU";
    if (!std::filesystem::exists("/usr/share/vulkan/icd.d/radeon_icd.x86_64.json"))
        GTEST_SKIP() << "this machine has no driver for an absent GPU";
    if (std::getenv("VK_DRIVER_FILES") || std::getenv("VK_ICD_FILENAMES"))
        GTEST_SKIP() << "drivers are chosen by the environment";
    const char* const said = "Driver \"radeon_icd.x86_64.json\" ignored";
    const ProgramRun run = stromboli({"devices"}, "VK_LOADER_DEBUG=driver");
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_THAT(run.err, HasSubstr(said));
    // What the user tells the loader stays.
    const ProgramRun told =
        stromboli({"devices"}, "VK_LOADER_DEBUG=driver VK_LOADER_DRIVERS_DISABLE=none");
    EXPECT_EQ(told.exitCode, 0);
    EXPECT_THAT(told.err, Not(HasSubstr(said)));
}

TEST_F(Devices, SharesAndSequencesUseThemToo) {
    const std::vector<std::string> share = {"render", libraryScene("cornell_boxes.dae"),
                                            "-r",     "32",
                                            "24",     "-s",
                                            "256",    "--share",
                                            "1/1",    "-o"};
    for (const std::string device : {"0", "0,0"}) {
        std::vector<std::string> words = share;
        words.insert(words.end(), {folder.file(device + ".film"), "--device", device});
        ASSERT_EQ(stromboli(words).exitCode, 0);
    }
    EXPECT_EQ(bytes("0.film"), bytes("0,0.film"));
    for (const std::string device : {"0", "0,0"}) {
        const ProgramRun run =
            stromboli({"render", libraryScene("cornell_boxes.dae"), "-r", "32", "24", "-s", "8",
                       "--turntable", "3", "--notes", "off", "--device", device, "-o",
                       folder.file("t" + device + "-%d.png")});
        ASSERT_EQ(run.exitCode, 0) << run.err;
    }
    for (const std::string frame : {"0", "1", "2"})
        EXPECT_EQ(bytes("t0-" + frame + ".png"), bytes("t0,0-" + frame + ".png"));
}

TEST_F(Devices, WhatIsNotThereIsNamed) {
    const ProgramRun none = render("0,7", "a.png");
    EXPECT_EQ(none.exitCode, kDevice);
    EXPECT_THAT(none.err, HasSubstr("there is no device 7"));
    EXPECT_THAT(render("0,,0", "a.png").err, HasSubstr("empty place"));
    const ProgramRun check =
        stromboli({"check", libraryScene("cornell_boxes.dae"), "--device", "all"});
    EXPECT_EQ(check.exitCode, kDevice);
    EXPECT_THAT(check.err, HasSubstr("'all' names several devices"));
    EXPECT_EQ(folder.entries().size(), 0u);
}

/// Two drivers that have nothing in common: the picture is the one that each of them makes, but for
/// the rounding of their arithmetic. With mirrors and glass, which
/// SwiftShader renders nowhere else in the suite.
TEST_F(Devices, DriversOfDifferentKindsShareAPicture) {
    const std::string swiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json",
                      lavapipe = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
    if (!std::filesystem::exists(swiftShader) || !std::filesystem::exists(lavapipe))
        GTEST_SKIP() << "SwiftShader is not installed (it is part of Debian's package chromium)";
    const std::string both = swiftShader + ":" + lavapipe, scene = "cornell_mirror_glass.dae";
    const ProgramRun together =
        render("all", "both.exr", "VK_ICD_FILENAMES=" + both + " VK_DRIVER_FILES=" + both, scene);
    ASSERT_EQ(together.exitCode, 0) << together.err;
    EXPECT_THAT(together.err, HasSubstr("SwiftShader"));
    EXPECT_THAT(together.err, HasSubstr("llvmpipe"));
    ASSERT_EQ(render("llvmpipe", "one.exr", "", scene).exitCode, 0);
    // Different roundings may send a path another way: of 98,304 samples some do.
    const ProgramRun compared = stromboli(
        {"compare", folder.file("one.exr"), folder.file("both.exr"), "--max-relmse", "1e-4"});
    EXPECT_EQ(compared.exitCode, 0) << compared.out << compared.err;
}

} // namespace
} // namespace stromboli::test
