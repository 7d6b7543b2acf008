// What pictures' files say in words.
#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stromboli {
namespace {

using testing::HasSubstr;
using testing::Not;

void writeWith(const std::filesystem::path& path, const PictureNotes& notes) {
    const Film film(3, 2);
    PictureFile file(path, film.area, {});
    file.place(film);
    file.write(notes);
}

PictureNotes sorted(PictureNotes notes) {
    std::sort(notes.begin(), notes.end(),
              [](const PictureNote& a, const PictureNote& b) { return a.name < b.name; });
    return notes;
}

const PictureNotes kNotes = {{"Software", "Stromboli 1.2.3"},
                             {"Scene", "M\xc3\xb6we \xe2\x82\xac.dae"},
                             {"Command", "stromboli render 'a b.dae' --strict"},
                             {"Long", std::string(100'000, 'x')},
                             {"ANameOf31LettersWhichIsTheMostXx", "most"},
                             {"Empty", ""}};

TEST(PictureNotes, ComeBack) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.exr"}) {
        PictureNotes notes = kNotes;
        notes[4].name.resize(31);
        writeWith(folder / name, notes);
        const PictureNotes back = readPictureNotes(folder / name);
        ASSERT_EQ(back.size(), notes.size()) << name;
        EXPECT_TRUE(sorted(back) == sorted(notes)) << name;
    }
}

TEST(PictureNotes, OfPngAreLatin1OnlyWhereTheyAreAscii) {
    const TemporaryFolder folder;
    writeWith(folder / "a.png", {{"Scene", "gull"}});
    EXPECT_THAT(contentOf(folder / "a.png"), HasSubstr(std::string("tEXtScene\0gull", 14)));
    writeWith(folder / "b.png", {{"Scene", "M\xc3\xb6we"}});
    EXPECT_THAT(contentOf(folder / "b.png"), HasSubstr("iTXtScene"));
    EXPECT_THAT(contentOf(folder / "b.png"), Not(HasSubstr("tEXt")));
}

TEST(PictureNotes, NoneLeaveNoTrace) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.exr"}) {
        writeWith(folder / name, {});
        EXPECT_TRUE(readPictureNotes(folder / name).empty()) << name;
    }
}

TEST(PictureNotes, CountAsPartOfTheLargestFile) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.exr"}) {
        writeWith(folder / name, kNotes);
        EXPECT_LE(std::filesystem::file_size(folder / name),
                  largestPictureFile(folder / name, 3, 2, {}, kNotes));
        EXPECT_LT(largestPictureFile(folder / name, 3, 2, {}), 100'000u);
    }
}

TEST(PictureNotes, OfWhatIsNoPictureAreAnError) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.exr"}) {
        EXPECT_THROW(readPictureNotes(folder / name), UsageError); // there is none
        std::ofstream(folder / name) << "no picture";
        EXPECT_THROW(readPictureNotes(folder / name), UsageError);
    }
    EXPECT_TRUE(namesPicture("A.PNG"));
    EXPECT_FALSE(namesPicture("a.dae"));
    EXPECT_FALSE(namesPicture("-"));
}

} // namespace
} // namespace stromboli
