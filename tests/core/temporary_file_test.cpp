// Files beside the one that is written: whose they are, and that none stays behind.
#include "host/core/files.hpp"

#include "host/core/error.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <future>
#include <sstream>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

class TemporaryFiles : public testing::Test {
  protected:
    TemporaryFiles() {
        std::string pattern = (fs::temp_directory_path() / "stromboli-XXXXXX").string();
        if (!mkdtemp(pattern.data())) throw std::runtime_error("no scratch folder");
        folder_ = pattern;
    }
    ~TemporaryFiles() override { fs::remove_all(folder_); }

    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
            all.push_back(entry.path().filename().string());
        std::sort(all.begin(), all.end());
        return all;
    }

    fs::path folder_;
    fs::path output() const { return folder_ / "a.png"; }
};

using Names = std::vector<std::string>;

TEST_F(TemporaryFiles, WhatKilledProgramsLeftIsRemovedAtTheNextWrite) {
    for (const char* name : {".a.png.77.0.tmp", ".a.png.77.12.tmp", // of this output
                             ".b.png.77.0.tmp", ".a.png.77.tmp", ".a.png.x.0.tmp", "a.png.1.1.tmp",
                             ".a.png.77.0.tmp.bak"})
        std::ofstream(folder_ / name) << "half";
    { const TemporaryFile file(output()); }
    EXPECT_EQ(names(), (Names{".a.png.77.0.tmp.bak", ".a.png.77.tmp", ".a.png.x.0.tmp",
                              ".b.png.77.0.tmp", "a.png.1.1.tmp"}));
}

/// Two writers of one output, in this process or in others, leave each other's file alone.
TEST_F(TemporaryFiles, ThoseThatAreWrittenAreNotTakenForAbandoned) {
    TemporaryFile first(output()), second(output());
    EXPECT_NE(first.name(), second.name());
    EXPECT_TRUE(fs::exists(first.name()));
    EXPECT_TRUE(fs::exists(second.name()));
    second.rename(Sync::Later);
    EXPECT_TRUE(fs::exists(first.name()));
    first.rename(Sync::Now);
    EXPECT_EQ(names(), Names{"a.png"});
}

TEST_F(TemporaryFiles, AProcessThatEndsRemovesThoseOfAllItsThreads) {
    EXPECT_EXIT(
        {
            TemporaryFile here(output());
            const TemporaryFile* const there =
                std::async(std::launch::async, [&] { return new TemporaryFile(output()); }).get();
            if (!fs::exists(here.name()) || !fs::exists(there->name())) _exit(1);
            removeTemporaryFilesForGood();
            _exit(0);
        },
        testing::ExitedWithCode(0), "");
    EXPECT_EQ(names(), Names{});
}

TEST_F(TemporaryFiles, NoneIsMadeOrNamedOnceTheyAreGoneForGood) {
    EXPECT_EXIT(
        {
            TemporaryFile file(output());
            removeTemporaryFilesForGood();
            auto late = std::async(std::launch::async, [&] { file.rename(Sync::Later); });
            // It must wait, however long: here as long as a loaded machine may need to do it.
            late.wait_for(std::chrono::milliseconds(200));
            _exit(fs::exists(output()) ? 1 : 0);
        },
        testing::ExitedWithCode(0), "");
    EXPECT_EQ(names(), Names{});
}

TEST_F(TemporaryFiles, ADiskThatIsTooSmallIsFoundOutBefore) {
    EXPECT_NO_THROW(checkFreeSpace(output(), 1));
    try {
        checkFreeSpace(output(), UINT64_MAX);
        FAIL() << "no disk has so much";
    } catch (const OutputError& error) {
        EXPECT_NE(std::string(error.what()).find("a.png: cannot write: it may need"),
                  std::string::npos);
    }
}

} // namespace
} // namespace stromboli
