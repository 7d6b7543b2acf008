// Files that are none, or have no end, are refused at once.

#include "scene/build/read_file.hpp"

#include "host/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace stromboli::build {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ReadFile : public testing::Test {
  protected:
    ReadFile() { std::filesystem::create_directories(folder_); }
    ~ReadFile() override { std::filesystem::remove_all(folder_); }

    static std::string messageOf(const std::filesystem::path& file) {
        try {
            readFile(file);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "no error";
    }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) /
                                    ("stromboli_read_file_" + std::to_string(getpid()));
};

TEST_F(ReadFile, GivesItsBytes) {
    const std::string bytes("a\0b\n\xFF", 5);
    std::ofstream(folder_ / "some", std::ios::binary) << bytes;
    EXPECT_EQ(readFile(folder_ / "some"), bytes);
    EXPECT_EQ(readFile(folder_ / "some", 2), bytes.substr(0, 2));
    EXPECT_EQ(readFile(folder_ / "some", 99), bytes);
    std::ofstream(folder_ / "none");
    EXPECT_EQ(readFile(folder_ / "none"), "");
}

/// Whoever clones or downloads without care has these under the names of scenes and pictures.
TEST_F(ReadFile, WhatStandsInForAFileIsRefused) {
    const auto messageOfText = [&](const char* text) {
        std::ofstream(folder_ / "some.glb", std::ios::binary) << text;
        return messageOf(folder_ / "some.glb");
    };
    EXPECT_THAT(messageOfText("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n"),
                AllOf(HasSubstr("some.glb: is a pointer of Git LFS"), HasSubstr("git lfs pull")));
    for (const char* page : {"<!DOCTYPE html>\n<html></html>", "\n <HTML><body>404</body></HTML>"})
        EXPECT_THAT(messageOfText(page), HasSubstr("is a web page"));
    EXPECT_EQ(messageOfText("<?xml version=\"1.0\"?><COLLADA/>"), "no error");
}

TEST_F(ReadFile, WhatIsNoFileIsRefused) {
    EXPECT_THAT(messageOf(folder_ / "gone"), AllOf(HasSubstr("gone"), HasSubstr("No such file")));
    EXPECT_THAT(messageOf(folder_), HasSubstr("is a directory"));
    EXPECT_THAT(messageOf("/dev/zero"), HasSubstr("/dev/zero: is a device"));
    // Nobody ever writes to it.
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(messageOf(folder_ / "pipe"), HasSubstr("is a pipe"));
    std::filesystem::create_symlink("/dev/random", folder_ / "link");
    EXPECT_THAT(messageOf(folder_ / "link"), HasSubstr("is a device"));
}

TEST_F(ReadFile, FilesWithoutASizeAreEmpty) {
    EXPECT_EQ(readFile("/proc/self/mem"), "");
    EXPECT_EQ(readFile("/proc/self/pagemap"), "");
}

TEST_F(ReadFile, FilesLargerThanTheMemoryAreRefused) {
    std::ofstream(folder_ / "huge").close();
    // Has no blocks on the disk.
    ASSERT_EQ(truncate((folder_ / "huge").c_str(), off_t(1) << 42), 0);
    EXPECT_THAT(messageOf(folder_ / "huge"),
                AllOf(HasSubstr("4194304 MiB"), HasSubstr("this machine has")));
    EXPECT_NO_THROW(requireMemory("file", 1));
}

} // namespace
} // namespace stromboli::build
