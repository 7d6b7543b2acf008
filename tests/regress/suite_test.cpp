// Suites of `stromboli regress`: what holds for all pictures and for one, and wrong files.
#include "host/core/error.hpp"
#include "host/regress/suite.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace stromboli::regress {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Reads a suite of this text, whose folder has a file room.xml.
Suite suiteOf(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder / "room.xml") << "<scene/>";
    std::ofstream(folder / "suite.toml") << text;
    return readSuite(folder / "suite.toml");
}

std::string refusalOfSuite(const std::string& text) {
    try {
        suiteOf(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(Suites, WhatIsSaidOfAllHoldsUnlessAPictureSaysOtherwise) {
    const Suite suite = suiteOf(R"(
        false_alarms = 0.02
        size = [64, 48]
        samples = 32
        options = "-m 3"
        limits = {flip = 0.1}
        [[picture]]
        scene = "room.xml"
        [[picture]]
        name = "dusk"
        scene = "cornell_boxes"
        golden = "elsewhere/dusk.png"
        size = [32, 24]
        samples = 8
        golden_samples = 100
        options = ["--env", "an evening.hdr"]
        limits = {relmse = 0.5, psnr = 20}
        seconds = 2
        megabytes = 300
    )");
    EXPECT_EQ(suite.falseAlarms, 0.02);
    ASSERT_EQ(suite.pictures.size(), 2u);
    const SuitePicture &room = suite.pictures[0], &dusk = suite.pictures[1];
    EXPECT_EQ(room.name, "room");
    EXPECT_EQ(room.scene, (suite.file.parent_path() / "room.xml").string());
    EXPECT_EQ(room.golden, suite.file.parent_path() / "golden" / "room.exr");
    EXPECT_EQ(room.width, 64u);
    EXPECT_EQ(room.samples, 32u);
    EXPECT_EQ(room.goldenSamples, 128u); // four times as many
    EXPECT_THAT(room.options, ElementsAre("-m", "3"));
    EXPECT_EQ(room.limits.flip, 0.1);
    EXPECT_FALSE(room.seconds);
    EXPECT_EQ(dusk.name, "dusk");
    EXPECT_EQ(dusk.scene, "cornell_boxes"); // no file of the folder
    EXPECT_EQ(dusk.golden, suite.file.parent_path() / "elsewhere" / "dusk.png");
    EXPECT_EQ(dusk.height, 24u);
    EXPECT_EQ(dusk.goldenSamples, 100u);
    EXPECT_THAT(dusk.options, ElementsAre("-m", "3", "--env", "an evening.hdr"));
    EXPECT_FALSE(dusk.limits.flip);
    EXPECT_EQ(dusk.limits.relMse, 0.5);
    EXPECT_EQ(dusk.limits.psnr, 20);
    EXPECT_EQ(dusk.seconds, 2);
    EXPECT_EQ(dusk.megabytes, 300);
}

TEST(Suites, WrongFilesAreRefusedWithTheLine) {
    const std::string picture = "[[picture]]\nscene = \"room.xml\"\n";
    EXPECT_THAT(refusalOfSuite("samples = \n"), HasSubstr("suite.toml:1:"));
    EXPECT_THAT(refusalOfSuite("size = [1, 1]\n"), HasSubstr("has no [[picture]]"));
    EXPECT_THAT(refusalOfSuite("sampels = 3\n" + picture),
                AllOf(HasSubstr("suite.toml:1: <sampels>"), HasSubstr("samples")));
    EXPECT_THAT(refusalOfSuite("\nsamples = 0\n" + picture),
                AllOf(HasSubstr("suite.toml:2: <samples>"), HasSubstr("from 1 to")));
    EXPECT_THAT(refusalOfSuite("size = [1]\n" + picture), HasSubstr("expected [width, height]"));
    EXPECT_THAT(refusalOfSuite("false_alarms = 2\n" + picture), HasSubstr("a number from"));
    EXPECT_THAT(refusalOfSuite("limits = {flap = 1}\n" + picture), HasSubstr("flip"));
    EXPECT_THAT(refusalOfSuite("options = 3\n" + picture), HasSubstr("options of render"));
    EXPECT_THAT(refusalOfSuite("[[picture]]\nname = \"a\"\n"), HasSubstr("has no scene"));
    EXPECT_THAT(refusalOfSuite(picture + picture), HasSubstr("two pictures have the name 'room'"));
    EXPECT_THAT(refusalOfSuite("[[picture]]\nscene = \"a\"\nname = \"../b\"\n"),
                HasSubstr("no name of a file"));
    EXPECT_THROW(readSuite("/nowhere/suite.toml"), SceneError);
}

TEST(Suites, PicturesAreChosenByName) {
    const Suite suite = suiteOf("[[picture]]\nscene = \"one\"\n[[picture]]\nscene = \"two\"\n"
                                "[[picture]]\nscene = \"three\"\n");
    EXPECT_EQ(chosen(suite, {}).size(), 3u);
    const std::vector<SuitePicture> some = chosen(suite, {"three", "one"});
    ASSERT_EQ(some.size(), 2u);
    EXPECT_EQ(some[0].name, "one"); // in the order of the suite
    try {
        chosen(suite, {"thre"});
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("no picture 'thre'"), HasSubstr("three")));
    }
}

} // namespace
} // namespace stromboli::regress
