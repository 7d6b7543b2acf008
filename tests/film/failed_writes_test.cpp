#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/failing_writes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <sys/stat.h>
#include <unistd.h>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

std::string messageOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const OutputError& error) {
        return error.what();
    }
    return "no OutputError";
}

/// Both the check before a render and the write after it refuse, naming the file and the reason.
void expectRefused(const fs::path& path, const std::string& reason) {
    const auto message = testing::AllOf(testing::StartsWith(path.string() + ": cannot write"),
                                        testing::HasSubstr(reason));
    EXPECT_THAT(messageOf([&] { checkWritable(path); }), message);
    EXPECT_THAT(messageOf([&] { writePicture(path, Film(2, 2), {}); }), message);
}

using test::AsNobody;
using test::FileSizeLimit;

class FailedWrites : public testing::TestWithParam<const char*> {
  protected:
    TemporaryFolder folder_;
    std::string name_ = std::string("a") + GetParam();
};

INSTANTIATE_TEST_SUITE_P(Kinds, FailedWrites, testing::Values(".png", ".exr", ".jpg", ".webp"),
                         [](const auto& kind) { return std::string(kind.param + 1); });

TEST_P(FailedWrites, MissingFolder) {
    expectRefused(folder_ / "none" / name_, "does not exist");
    EXPECT_EQ(folder_.size(), 0u);
}

TEST_P(FailedWrites, FileInThePlaceOfTheFolder) {
    std::ofstream(folder_ / "file") << "x";
    expectRefused(folder_ / "file" / name_, "folder");
}

TEST_P(FailedWrites, FolderInThePlaceOfTheFile) {
    fs::create_directory(folder_ / name_);
    expectRefused(folder_ / name_, "it is a folder");
    EXPECT_TRUE(fs::is_empty(folder_ / name_));
}

TEST_P(FailedWrites, UnwritableFolder) {
    fs::create_directory(folder_ / "locked");
    fs::permissions(folder_.path(), fs::perms::all);
    fs::permissions(folder_ / "locked", fs::perms(0555));
    const AsNobody nobody;
    if (!nobody.works()) GTEST_SKIP() << "root that may not change its user";
    expectRefused(folder_ / "locked" / name_, "Permission denied");
    EXPECT_TRUE(fs::is_empty(folder_ / "locked"));
}

TEST_P(FailedWrites, UnwritableFileIsNotReplaced) {
    std::ofstream(folder_ / name_) << "old";
    fs::permissions(folder_ / name_, fs::perms(0444));
    fs::permissions(folder_.path(), fs::perms::all);
    const AsNobody nobody;
    if (!nobody.works()) GTEST_SKIP() << "root that may not change its user";
    expectRefused(folder_ / name_, "Permission denied");
    EXPECT_EQ(fs::file_size(folder_ / name_), 3u);
}

TEST_P(FailedWrites, AWriteThatFailsHalfWayLeavesTheOldFile) {
    std::ofstream(folder_ / name_) << "old";
    Film film(64, 64);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        film.pixels[i].add(glm::dvec3(double(i * 7919 % 4099) / 4099)); // compresses badly
    {
        const FileSizeLimit limit(100);
        EXPECT_THAT(messageOf([&] { writePicture(folder_ / name_, film, {}); }),
                    testing::HasSubstr("File too large"));
    }
    EXPECT_EQ(folder_.size(), 1u);
    EXPECT_EQ(fs::file_size(folder_ / name_), 3u);
    writePicture(folder_ / name_, film, {});
    EXPECT_EQ(folder_.size(), 1u);
    EXPECT_GT(fs::file_size(folder_ / name_), 100u);
}

TEST_P(FailedWrites, CheckLeavesEverythingAsItWas) {
    checkWritable(folder_ / name_);
    EXPECT_EQ(folder_.size(), 0u);
    std::ofstream(folder_ / name_) << "old";
    checkWritable(folder_ / name_);
    EXPECT_EQ(folder_.size(), 1u);
    EXPECT_EQ(fs::file_size(folder_ / name_), 3u);
}

TEST_P(FailedWrites, FilesLeftByAKilledProcessAreRemoved) {
    const std::string leftover = "." + name_ + "." + std::to_string(::getpid()) + ".0.tmp";
    std::ofstream(folder_ / leftover) << "x";
    writePicture(folder_ / name_, Film(1, 1), {});
    EXPECT_TRUE(fs::exists(folder_ / name_));
    EXPECT_EQ(folder_.size(), 1u);
}

TEST_P(FailedWrites, SymbolicLinkIsFollowedAndKept) {
    fs::create_directory(folder_ / "elsewhere");
    fs::create_symlink(folder_ / "elsewhere" / name_, folder_ / name_);
    writePicture(folder_ / name_, Film(1, 1), {});
    EXPECT_TRUE(fs::is_symlink(folder_ / name_));
    EXPECT_TRUE(fs::is_regular_file(folder_ / "elsewhere" / name_));
}

TEST_P(FailedWrites, SymbolicLinkToItself) {
    fs::create_symlink(name_, folder_ / name_);
    expectRefused(folder_ / name_, "symbolic links");
}

TEST_P(FailedWrites, NewFilesObeyTheUmask) {
    const mode_t before = ::umask(0027);
    writePicture(folder_ / name_, Film(1, 1), {});
    ::umask(before);
    EXPECT_EQ(fs::status(folder_ / name_).permissions(), fs::perms(0640));
}

TEST(CheckWritable, UnknownExtensionIsAUsageError) {
    const TemporaryFolder folder;
    for (const std::string name : {"a", "a.gif", "a.png.bak", ".png", "png"}) {
        EXPECT_THROW(checkWritable(folder / name), UsageError) << name;
        EXPECT_THROW(writePicture(folder / name, Film(1, 1), {}), UsageError) << name;
    }
    EXPECT_EQ(folder.size(), 0u);
    EXPECT_NO_THROW(checkWritable(folder / "a.Exr"));
}

} // namespace
} // namespace stromboli
