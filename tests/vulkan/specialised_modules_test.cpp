// Modules with their constants in place, kept between runs.
#include "host/spirv/specialise.hpp"
#include "host/vulkan/specialised_modules.hpp"
#include "tests/film/temporary_folder.hpp"

#include "embedded/squares_shader.h"

#include <gtest/gtest.h>

#include <cstring>

namespace stromboli::vulkan {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<uint32_t>;

/// A module that is large enough to be kept, by a string for debuggers that specialising drops.
Words largeModule(uint32_t filling = 0) {
    constexpr uint32_t kHeader = 5, kOpString = 7, kLength = 60'000;
    Words module(std::begin(squares_shader), std::end(squares_shader));
    for (size_t added = 0; added < SpecialisedModules::kLeastWords; added += kLength) {
        Words text(kLength, filling);
        text[0] = kLength << 16 | kOpString;
        module.insert(module.begin() + kHeader, text.begin(), text.end());
    }
    return module;
}

class KeptModules : public testing::Test {
  protected:
    Words get(const Words& module, uint32_t factor) const {
        return modules_.get(module, {&factor, 1}).value_or(Words());
    }
    static Words made(const Words& module, uint32_t factor) {
        return spirv::specialise(module, {&factor, 1}).value_or(Words());
    }
    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        std::error_code none; // there is no folder before the first is kept
        for (const auto& entry : fs::directory_iterator(folder_ / "kernels", none))
            found.push_back(entry.path());
        return found;
    }

    TemporaryFolder folder_;
    SpecialisedModules modules_{BlobCache(folder_.path())};
};

/// A mark put into what was kept shows that it is what the next run gets.
TEST_F(KeptModules, AreFoundByTheNextRun) {
    const Words module = largeModule();
    const Words expected = made(module, 7);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(get(module, 7), expected);
    ASSERT_EQ(files().size(), 1u);
    EXPECT_EQ(get(module, 7), expected);

    const BlobCache cache(folder_ / "kernels");
    const std::string name = files()[0].stem().string();
    auto blob = cache.find(name).value();
    blob.back() ^= std::byte(1);
    cache.keep(name, blob);
    Words marked = expected;
    marked.back() ^= 1u << 24;
    EXPECT_EQ(get(module, 7), marked);
}

TEST_F(KeptModules, OfOtherCodeOrConstantsAreKeptApart) {
    EXPECT_EQ(get(largeModule(), 7), made(largeModule(), 7));
    EXPECT_EQ(get(largeModule(), 8), made(largeModule(), 8));
    EXPECT_NE(get(largeModule(), 7), get(largeModule(), 8));
    EXPECT_EQ(get(largeModule(1), 7), made(largeModule(), 7));
    EXPECT_EQ(files().size(), 3u);
}

/// Also where a file of another key has the name, as one whose hash is the same would.
TEST_F(KeptModules, OfAnotherKeyAreNotTaken) {
    get(largeModule(), 7);
    const std::string name = files()[0].stem().string();
    get(largeModule(), 8);
    const BlobCache cache(folder_ / "kernels");
    for (const fs::path& file : files())
        if (file.stem().string() != name) cache.keep(name, *cache.find(file.stem().string()));
    EXPECT_EQ(get(largeModule(), 7), made(largeModule(), 7));
}

TEST_F(KeptModules, DamagedFileIsReplaced) {
    get(largeModule(), 7);
    const auto whole = fs::file_size(files()[0]);
    fs::resize_file(files()[0], whole - 4);
    EXPECT_EQ(get(largeModule(), 7), made(largeModule(), 7));
    EXPECT_EQ(fs::file_size(files()[0]), whole);
}

TEST_F(KeptModules, OfFewWordsAreMadeEachTime) {
    const Words module(std::begin(squares_shader), std::end(squares_shader));
    EXPECT_EQ(get(module, 7), made(module, 7));
    EXPECT_TRUE(files().empty());
}

TEST_F(KeptModules, WithoutACacheTheyAreMade) {
    const uint32_t factor = 7;
    EXPECT_EQ(SpecialisedModules(std::nullopt).get(largeModule(), {&factor, 1}),
              made(largeModule(), 7));
    EXPECT_TRUE(files().empty());
}

/// What the specialiser cannot read goes to the driver as it is, and is not kept.
TEST_F(KeptModules, OfUnknownInstructionsAreNone) {
    Words module = largeModule();
    module.insert(module.begin() + 5, 1u << 16 | 0xFFFFu);
    const uint32_t factor = 7;
    EXPECT_FALSE(modules_.get(module, {&factor, 1}));
    EXPECT_TRUE(files().empty());
}

} // namespace
} // namespace stromboli::vulkan
