// Names of files in files, as machines with other rules write them.

#include "scene/build/companion.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace stromboli::build {
namespace {

namespace fs = std::filesystem;

/// A folder of empty files that is the current one while it lives.
class CompanionFolder {
  public:
    explicit CompanionFolder(std::initializer_list<std::string> files)
        : before_(fs::current_path()),
          path_(fs::path(testing::TempDir()) / fmt::format("stromboli_companion_{}", getpid())) {
        fs::create_directories(path_ / "maps");
        for (const std::string& file : files)
            std::ofstream(path_ / file) << file;
        fs::current_path(path_);
    }
    ~CompanionFolder() {
        fs::current_path(before_);
        fs::remove_all(path_);
    }
    CompanionFolder(const CompanionFolder&) = delete;
    CompanionFolder& operator=(const CompanionFolder&) = delete;

    const fs::path& path() const { return path_; }

  private:
    fs::path before_, path_;
};

/// The folder of a scene that is named without one is empty.
TEST(Companions, OfFoldersWithOtherCapitalsAreFoundFromTheCurrentOneToo) {
    const CompanionFolder folder({"maps/wood.png"});
    for (const fs::path& from : {fs::path(), fs::path("."), folder.path()}) {
        const Companion found = companion(from, "Maps/Wood.PNG");
        ASSERT_TRUE(found.path) << from;
        EXPECT_EQ(*found.path, from / "maps/wood.png");
        EXPECT_FALSE(found.problem.empty());
    }
}

TEST(Companions, MayHaveTheCodesOfUrisOrBytesOfLatin1) {
    const CompanionFolder folder({"old wood.png", "h\xC3\xA4user.png", "100%25.png"});
    EXPECT_EQ(companion("", "old%20wood.png").path, "old wood.png");
    EXPECT_FALSE(companion("", "old%20wood.png").problem.empty());
    EXPECT_EQ(companion("", "h\xE4user.png").path, "h\xC3\xA4user.png");
    // A name that is there as it is written is never read otherwise.
    EXPECT_EQ(companion("", "100%25.png").path, "100%25.png");
    EXPECT_TRUE(companion("", "100%25.png").problem.empty());
    EXPECT_FALSE(companion("", "%2e%2e/stromboli.png").path);
}

TEST(Companions, OfPicturesMayHaveAnotherEnding) {
    const CompanionFolder folder({"maps/wood.png", "wall.jpg", "wall.obj", ".png", "roof.dds",
                                  "tile.tif", "brick.psd", "brick.jpg", "sand.ktx2"});
    EXPECT_EQ(pictureCompanion("", "maps/wood.psd").path, "maps/wood.png");
    EXPECT_EQ(pictureCompanion("", "C:\\maps\\wall.tif").path, "wall.jpg");
    EXPECT_EQ(pictureCompanion("", "wall").path, "wall.jpg");
    EXPECT_FALSE(pictureCompanion("", "wall.tif").problem.empty());
    EXPECT_EQ(companion("", "wall.tif").path, "wall.jpg");
    EXPECT_EQ(companion("", "roof.tga").path, "roof.dds");
    EXPECT_EQ(companion("", "tile.png").path, "tile.tif");
    // What is not read is as good as not there, unless there is nothing else.
    EXPECT_EQ(companion("", "brick.psd").path, "brick.jpg");
    EXPECT_THAT(companion("", "brick.psd").problem, testing::HasSubstr("kind that is not read"));
    EXPECT_EQ(companion("", "sand.ktx2").path, "sand.ktx2");
    EXPECT_EQ(companion("", "sand.ktx2").problem, "");
    EXPECT_FALSE(companion("", "wall.stl").path);
    EXPECT_FALSE(companion("", "wall").path);
    EXPECT_FALSE(pictureCompanion("", "floor.tif").path);
    EXPECT_FALSE(pictureCompanion("", ".tif").path);
}

} // namespace
} // namespace stromboli::build
