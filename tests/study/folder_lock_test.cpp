#include "host/core/error.hpp"
#include "host/study/journal.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

namespace stromboli::study {
namespace {

using testing::HasSubstr;

/// A lock belongs to an open file, so that two of one process stand for two processes.
TEST(FolderLock, OneStudyAtATime) {
    const TemporaryFolder folder;
    std::optional<FolderLock> first(folder.path());
    try {
        const FolderLock second(folder.path());
        FAIL() << "both have the folder";
    } catch (const OutputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(folder.path().string()));
        EXPECT_THAT(error.what(), HasSubstr("another study"));
    }
    first.reset();
    EXPECT_NO_THROW(FolderLock(folder.path()));
}

TEST(FolderLock, NeedsTheFolder) {
    const TemporaryFolder folder;
    EXPECT_THROW(FolderLock(folder.path() / "missing"), OutputError);
}

} // namespace
} // namespace stromboli::study
