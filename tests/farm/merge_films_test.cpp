// Films of shares add up to the same bits, however they are cut and put together.
#include "host/core/error.hpp"
#include "host/farm/merge_films.hpp"
#include "tests/farm/films.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <random>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

namespace fs = std::filesystem;

/// 1000 samples of few pixels, each a block.
FilmHeader smallPicture() {
    FilmHeader picture = pictureOf(1000, 1);
    picture.settings.area = {3, 2, {}};
    return picture;
}

class MergeFilms : public testing::Test {
  protected:
    TemporaryFolder folder_;

    std::vector<fs::path> shares(const FilmHeader& picture, uint32_t count) {
        std::vector<fs::path> files;
        for (uint32_t i = 1; i <= count; ++i) {
            const FilmHeader header = ofShare(picture, {i, count});
            files.push_back(folder_ / (std::to_string(i) + "of" + std::to_string(count) + ".film"));
            writeFilm(files.back(), header, drawBlocks(header, uneven, 1));
        }
        return files;
    }
    static std::vector<SharedPixel> sumOf(const std::vector<fs::path>& files) {
        FilmsToMerge films(files);
        std::vector<SharedPixel> sum;
        films.addUp([&](const PictureArea&, std::span<const SharedPixel> run,
                        std::span<const float>) { sum.insert(sum.end(), run.begin(), run.end()); });
        return sum;
    }
    fs::path merged(const std::vector<fs::path>& files, const std::string& name) {
        FilmsToMerge films(files);
        FilmWriter writer(folder_ / name, films.header());
        films.addUp(
            [&](const PictureArea&, std::span<const SharedPixel> run, std::span<const float>) {
                if (!films.header().isEmpty()) writer.add(run);
            });
        writer.finish();
        return folder_ / name;
    }
    static std::string refusalOf(const std::vector<fs::path>& files) {
        return test::refusalOf([&] { const FilmsToMerge films(files); });
    }
};

TEST_F(MergeFilms, AnyNumberInAnyOrder) {
    const std::vector<SharedPixel> whole = drawBlocks(ofShare(smallPicture(), {1, 1}), uneven, 1);
    std::mt19937 random(1);
    for (uint32_t count : {1u, 2u, 7u, 64u, 1000u}) {
        std::vector<fs::path> files = shares(smallPicture(), count);
        EXPECT_EQ(sumOf(files), whole) << count;
        std::shuffle(files.begin(), files.end(), random);
        EXPECT_EQ(sumOf(files), whole) << count << ", in another order";
    }
}

/// More shares than blocks: nine of ten are empty.
TEST_F(MergeFilms, SharesWithoutSamplesDoNoHarm) {
    FilmHeader picture = smallPicture();
    picture.settings.budget.samplesPerBlock = 10;
    EXPECT_EQ(sumOf(shares(picture, 1000)), drawBlocks(ofShare(picture, {1, 1}), uneven, 1));
}

TEST_F(MergeFilms, TwoLevelsMakeTheSameFile) {
    std::vector<fs::path> files = shares(smallPicture(), 64);
    const std::string atOnce = contentOf(merged(files, "a.film"));
    std::mt19937 random(2);
    for (int trial = 0; trial < 3; ++trial) {
        std::shuffle(files.begin(), files.end(), random);
        std::vector<fs::path> groups;
        for (size_t first = 0; first < files.size();) {
            const size_t count = std::min<size_t>(1 + random() % 15, files.size() - first);
            groups.push_back(merged({files.begin() + std::ptrdiff_t(first),
                                     files.begin() + std::ptrdiff_t(first + count)},
                                    "group" + std::to_string(first) + ".film"));
            first += count;
        }
        EXPECT_TRUE(contentOf(merged(groups, "b.film")) == atOnce);
    }
}

TEST_F(MergeFilms, WhatIsMissingIsTheRest) {
    const std::vector<fs::path> files = shares(smallPicture(), 8);
    const FilmsToMerge some({files[0], files[2], files[7]});
    EXPECT_EQ(some.header().samples(), 375u);
    EXPECT_EQ(missingFrom(some.header()), "shares 2 and 4 to 7 of 8 are missing");
    for (const SharedPixel& p : sumOf({files[0], files[2], files[7]}))
        EXPECT_EQ(p.all.taken(), 375u);
}

TEST_F(MergeFilms, RefusesForeignAndDoubledOnes) {
    const std::vector<fs::path> files = shares(smallPicture(), 4);
    FilmHeader other = smallPicture();
    other.identity.sceneSum = 43;
    const FilmHeader foreign = ofShare(other, {2, 4});
    writeFilm(folder_ / "foreign.film", foreign, drawBlocks(foreign, uneven, 1));
    EXPECT_THAT(refusalOf({files[0], folder_ / "foreign.film"}),
                HasSubstr("foreign.film is of another scene or camera"));
    EXPECT_THAT(refusalOf({files[0], files[1], files[0]}),
                HasSubstr("1of4.film: share 1/4 would be counted twice"));
    const fs::path half = merged({files[0], files[1]}, "half.film");
    EXPECT_THAT(refusalOf({half, files[1]}), HasSubstr("share 2/4 would be counted twice"));
    EXPECT_EQ(refusalOf({half, files[2], files[3]}), "");
}

/// Rows of a part of the picture, in runs.
TEST_F(MergeFilms, SaysWhichRowsARunIs) {
    FilmHeader picture = pictureOf(1, 1);
    picture.settings.area = {900, 400, {100, 50, 700, 300}};
    const FilmHeader header = ofShare(picture, {1, 1});
    std::vector<SharedPixel> pixels(700 * 300);
    writeFilm(folder_ / "a.film", header, pixels);
    FilmsToMerge films({folder_ / "a.film"});
    uint32_t row = 50;
    films.addUp(
        [&](const PictureArea& part, std::span<const SharedPixel> run, std::span<const float>) {
            const Crop rows = part.rendered();
            EXPECT_EQ(part.width, 900u);
            EXPECT_EQ(rows.x, 100u);
            EXPECT_EQ(rows.y, row);
            EXPECT_EQ(rows.width, 700u);
            EXPECT_EQ(run.size(), 700u * rows.height);
            row += rows.height;
        });
    EXPECT_EQ(row, 350u);
}

/// 64 films whose sums take 3.5 MB each, and much more than is kept of a run: while they are added
/// up, the process grows by less than half of what all of them take.
TEST_F(MergeFilms, TakesBoundedMemory) {
    FilmHeader picture = pictureOf(64, 1);
    picture.settings.area = {125, 120, {}};
    const std::vector<SharedPixel> pixels(125 * 120);
    std::vector<fs::path> files;
    for (uint32_t i = 1; i <= 64; ++i) {
        files.push_back(folder_ / (std::to_string(i) + ".film"));
        writeFilm(files.back(), ofShare(picture, {i, 64}), pixels);
    }
    const auto peak = [] {
        rusage usage = {};
        getrusage(RUSAGE_SELF, &usage);
        return uint64_t(usage.ru_maxrss) << 10;
    };
    const uint64_t before = peak();
    EXPECT_EQ(sumOf(files).size(), pixels.size());
    EXPECT_LT(peak() - before, 64 * pixels.size() * sizeof(SharedPixel) / 2);
}

} // namespace
} // namespace stromboli
