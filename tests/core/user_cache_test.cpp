// A cache that may be damaged, shared, full or forbidden, and never stands in the way.
#include "host/core/user_cache.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/failing_writes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stromboli {
namespace {

namespace fs = std::filesystem;
using testing::Optional;
using Blob = std::vector<std::byte>;

Blob blobOf(size_t size, uint8_t seed = 1) {
    Blob blob(size);
    for (size_t i = 0; i < size; ++i)
        blob[i] = std::byte(seed + i * 31);
    return blob;
}

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void setContent(const fs::path& path, const std::string& content) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

/// An environment variable with another value, or none, until the end of the test.
class Variable {
  public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        set(value);
    }
    ~Variable() { set(before_ ? before_->c_str() : nullptr); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    void set(const char* value) { value ? setenv(name_, value, 1) : unsetenv(name_); }

    const char* name_;
    std::optional<std::string> before_;
};

std::optional<fs::path> folderWith(const char* own, const char* xdg, const char* home) {
    const Variable a("STROMBOLI_CACHE_DIR", own), b("XDG_CACHE_HOME", xdg), c("HOME", home);
    return userCacheFolder();
}

TEST(UserCache, FolderFollowsTheEnvironment) {
    EXPECT_THAT(folderWith(nullptr, nullptr, "/home/a"),
                Optional(fs::path("/home/a/.cache/stromboli")));
    EXPECT_THAT(folderWith(nullptr, "/caches", "/home/a"), Optional(fs::path("/caches/stromboli")));
    EXPECT_THAT(folderWith("/own", "/caches", "/home/a"), Optional(fs::path("/own")));
    EXPECT_EQ(folderWith("", "/caches", "/home/a"), std::nullopt);
    EXPECT_EQ(folderWith(nullptr, nullptr, nullptr), std::nullopt);
    EXPECT_EQ(folderWith(nullptr, nullptr, ""), std::nullopt);
    // Relative paths are to be ignored (XDG Base Directory Specification).
    EXPECT_THAT(folderWith(nullptr, "caches", "/home/a"),
                Optional(fs::path("/home/a/.cache/stromboli")));
}

class Cache : public testing::Test {
  protected:
    /// The one file in the folder.
    fs::path file() const {
        EXPECT_EQ(folder_.size(), 1u);
        return fs::directory_iterator(folder_.path())->path();
    }

    TemporaryFolder folder_;
    BlobCache cache_{folder_.path()};
};

TEST_F(Cache, WhatIsKeptIsFound) {
    EXPECT_EQ(cache_.find("a"), std::nullopt);
    for (size_t size : {0, 1, 4096, 1'000'000}) {
        cache_.keep("a", blobOf(size));
        EXPECT_THAT(cache_.find("a"), Optional(blobOf(size)));
    }
    EXPECT_EQ(cache_.find("b"), std::nullopt);
    EXPECT_EQ(folder_.size(), 1u);
}

TEST_F(Cache, FolderIsMadeWhenNeeded) {
    const BlobCache deeper(folder_ / "not" / "yet");
    EXPECT_EQ(deeper.find("a"), std::nullopt);
    EXPECT_EQ(folder_.size(), 0u);
    deeper.keep("a", blobOf(10));
    EXPECT_THAT(deeper.find("a"), Optional(blobOf(10)));
}

TEST_F(Cache, NoChangedByteIsTakenForABlob) {
    cache_.keep("a", blobOf(50));
    const std::string good = contentOf(file());
    for (size_t i = 0; i < good.size(); ++i)
        for (char flip : {'\x01', '\x80', '\xFF'}) {
            std::string bad = good;
            bad[i] = char(bad[i] ^ flip);
            setContent(file(), bad);
            ASSERT_EQ(cache_.find("a"), std::nullopt) << "byte " << i;
        }
    setContent(file(), good);
    EXPECT_THAT(cache_.find("a"), Optional(blobOf(50)));
}

TEST_F(Cache, NoOtherLengthIsTakenForABlob) {
    cache_.keep("a", blobOf(50));
    const std::string good = contentOf(file());
    for (size_t length = 0; length < good.size(); ++length) {
        setContent(file(), good.substr(0, length));
        ASSERT_EQ(cache_.find("a"), std::nullopt) << length;
    }
    setContent(file(), good + "x");
    EXPECT_EQ(cache_.find("a"), std::nullopt);
    cache_.keep("a", blobOf(50, 2)); // and it heals
    EXPECT_THAT(cache_.find("a"), Optional(blobOf(50, 2)));
}

TEST_F(Cache, NothingThatIsNoFileIsRead) {
    cache_.keep("a", blobOf(50));
    const fs::path path = file();
    fs::remove(path);
    fs::create_directory(path);
    EXPECT_EQ(cache_.find("a"), std::nullopt);
    cache_.keep("a", blobOf(50));
    EXPECT_TRUE(fs::is_directory(path));
}

TEST_F(Cache, UnwritableFolderIsNoError) {
    fs::create_directory(folder_ / "locked");
    fs::permissions(folder_.path(), fs::perms::all);
    fs::permissions(folder_ / "locked", fs::perms(0555));
    const test::AsNobody nobody;
    if (!nobody.works()) GTEST_SKIP() << "root that may not change its user";
    for (const BlobCache& cache :
         {BlobCache(folder_ / "locked"), BlobCache(folder_ / "locked" / "new")}) {
        cache.keep("a", blobOf(50));
        EXPECT_EQ(cache.find("a"), std::nullopt);
    }
    EXPECT_TRUE(fs::is_empty(folder_ / "locked"));
}

TEST_F(Cache, UnreadableFileIsNoError) {
    cache_.keep("a", blobOf(50));
    fs::permissions(folder_.path(), fs::perms::all);
    fs::permissions(file(), fs::perms(0));
    const test::AsNobody nobody;
    if (!nobody.works()) GTEST_SKIP() << "root that may not change its user";
    EXPECT_EQ(cache_.find("a"), std::nullopt);
}

TEST_F(Cache, FileInThePlaceOfTheFolderIsNoError) {
    setContent(folder_ / "file", "x");
    const BlobCache cache(folder_ / "file");
    cache.keep("a", blobOf(50));
    EXPECT_EQ(cache.find("a"), std::nullopt);
    EXPECT_EQ(contentOf(folder_ / "file"), "x");
}

TEST_F(Cache, FullDiskLeavesTheOldBlob) {
    cache_.keep("a", blobOf(50));
    {
        const test::FileSizeLimit limit(100);
        cache_.keep("a", blobOf(5000));
    }
    EXPECT_THAT(cache_.find("a"), Optional(blobOf(50)));
    EXPECT_EQ(folder_.size(), 1u);
}

TEST_F(Cache, KeepsFewBlobsAndTouchesNothingElse) {
    setContent(folder_ / "holiday.blob", "x");
    setContent(folder_ / "notes", "x");
    const auto age = [&](const std::string& name, int hours) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path()))
            if (entry.path().filename().string().starts_with(name + "."))
                fs::last_write_time(entry,
                                    fs::file_time_type::clock::now() - std::chrono::hours(hours));
    };
    const int count = 2 * int(BlobCache::kMostBlobs);
    for (int i = 0; i < count; ++i) {
        cache_.keep(std::to_string(i), blobOf(10));
        age(std::to_string(i), count - i);
    }
    EXPECT_EQ(folder_.size(), BlobCache::kMostBlobs + 2);
    for (int i = 0; i < count; ++i)
        EXPECT_EQ(cache_.find(std::to_string(i)).has_value(),
                  i >= count - int(BlobCache::kMostBlobs))
            << i;
    EXPECT_EQ(contentOf(folder_ / "holiday.blob") + contentOf(folder_ / "notes"), "xx");
}

TEST_F(Cache, WithinAnotherHasAFolderAndANumberOfItsOwn) {
    const BlobCache inner = cache_.within("inner", 2);
    for (const char* name : {"a", "b", "c"}) {
        cache_.keep(name, blobOf(20));
        inner.keep(name, blobOf(10));
    }
    const auto kept = [](const BlobCache& cache) {
        return cache.find("a").has_value() + cache.find("b").has_value() +
               cache.find("c").has_value();
    };
    EXPECT_EQ(kept(cache_), 3);
    EXPECT_EQ(kept(inner), 2);
    EXPECT_THAT(cache_.find("c"), Optional(blobOf(20)));
}

TEST_F(Cache, LeftoversOfKilledProgramsGoWithTheOldest) {
    cache_.keep("a", blobOf(10));
    const std::string name = file().filename().string();
    for (size_t i = 0; i < 3 * BlobCache::kMostBlobs; ++i) { // as writeFileAtomically names them
        // Leftovers of another blob: those of the same one go when it is written.
        const fs::path leftover = folder_ / (".b" + name + ".77." + std::to_string(i) + ".tmp");
        setContent(leftover, "half a blo");
        fs::last_write_time(leftover, fs::file_time_type::clock::now() - std::chrono::hours(1));
    }
    cache_.keep("a", blobOf(11));
    EXPECT_EQ(folder_.size(), BlobCache::kMostBlobs);
    EXPECT_THAT(cache_.find("a"), Optional(blobOf(11)));
}

TEST_F(Cache, BlobThatIsTooLargeMakesAFreshStart) {
    cache_.keep("a", blobOf(50));
    cache_.keep("a", Blob(BlobCache::kMostBytes + 1));
    EXPECT_EQ(cache_.find("a"), std::nullopt);
    EXPECT_EQ(folder_.size(), 0u);
}

/// Processes that all write and read the same name only ever see whole blobs.
TEST_F(Cache, ConcurrentProgramsSeeWholeBlobs) {
    constexpr int kPrograms = 4, kRounds = 100;
    const auto size = [](int program) { return size_t(20'000 + 7'000 * program); };
    const auto isWhole = [&](const Blob& blob) {
        for (int program = 0; program < kPrograms; ++program)
            if (blob == blobOf(size(program), uint8_t(program))) return true;
        return false;
    };
    cache_.keep("a", blobOf(size(0), 0));
    std::vector<pid_t> children;
    for (int program = 0; program < kPrograms; ++program) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            bool whole = true;
            for (int round = 0; round < kRounds; ++round) {
                cache_.keep("a", blobOf(size(program), uint8_t(program)));
                const std::optional<Blob> found = cache_.find("a");
                whole = whole && found && isWhole(*found);
            }
            ::_exit(whole ? 0 : 1);
        }
        children.push_back(child);
    }
    for (pid_t child : children) {
        int status = -1;
        ::waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(folder_.size(), 1u);
    const std::optional<Blob> last = cache_.find("a");
    ASSERT_TRUE(last);
    EXPECT_TRUE(isWhole(*last));
}

} // namespace
} // namespace stromboli
