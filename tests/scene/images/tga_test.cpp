#include "host/core/error.hpp"
#include "scene/images/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli::images {
namespace {

using testing::ElementsAre;

/// A header of 18 bytes for a picture of 2 x 2 pixels.
std::string header(int kind, int bits, int descriptor, int tableLength = 0) {
    const int values[18] = {
        0,    tableLength > 0, kind, 0, 0, tableLength, 0, 24, 0, 0, 0, 0, 2, 0, 2, 0,
        bits, descriptor};
    std::string bytes;
    for (const int value : values)
        bytes += char(value);
    return bytes;
}

/// The red channel (or grey) of the four pixels, from the top.
std::vector<int> redOf(const std::string& bytes) {
    const Picture picture = decodePicture(bytes, "a.tga");
    const auto& values = std::get<std::vector<uint8_t>>(picture.values);
    return {values[0], values[4], values[8], values[12]};
}

TEST(Tga, RowsComeFromBelowAndBlueFirst) {
    const std::string pixels("\0\0\1\0\0\2\0\0\3\0\0\4", 12);
    EXPECT_THAT(redOf(header(2, 24, 0) + pixels), ElementsAre(3, 4, 1, 2));
    EXPECT_THAT(redOf(header(2, 24, 32) + pixels), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(redOf(header(2, 24, 48) + pixels), ElementsAre(2, 1, 4, 3));
    EXPECT_THAT(redOf(header(2, 16, 32) + std::string("\0\x7C\0\0\0\0\0\x7C", 8)),
                ElementsAre(255, 0, 0, 255));
}

TEST(Tga, GreyTablesAndRuns) {
    EXPECT_THAT(redOf(header(3, 8, 32) + "\1\2\3\4"), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(redOf(header(1, 8, 32, 2) + std::string("\0\0\5\0\0\6\1\0\1\1", 10)),
                ElementsAre(6, 5, 6, 6));
    EXPECT_THAT(redOf(header(11, 8, 32) + "\x82\7" + std::string("\0\x9", 2)),
                ElementsAre(7, 7, 7, 9));
}

TEST(Tga, DamagedOnesAreErrors) {
    for (const std::string& bad :
         {header(2, 24, 0), header(1, 8, 0, 2) + std::string("\0\0\5\0\0\6\1\0\2\1", 10),
          header(9, 8, 0, 9)})
        EXPECT_THROW(decodePicture(bad, "a.tga"), SceneError);
}

/// Pixels that are there are shown, and what is missing is mid grey.
TEST(Tga, ThatEndsTooEarlyIsShownAsFarAsItGoes) {
    const std::pair<std::string, std::vector<int>> files[] = {
        {header(2, 24, 32) + std::string("\0\0\1\0\0\2\0\0\3\0\0", 11), {1, 2, 3, 127}},
        {header(11, 8, 32) + "\x82\7", {7, 7, 7, 127}},
        {header(11, 8, 32) + "\x82", {127, 127, 127, 127}}};
    for (const auto& [file, red] : files) {
        EXPECT_EQ(redOf(file), red);
        const Picture picture = decodePicture(file, "a.tga");
        EXPECT_EQ(std::get<std::vector<uint8_t>>(picture.values).at(15), 255);
        ASSERT_EQ(picture.faults.size(), 1u);
        EXPECT_EQ(picture.faults[0].problem, "the file is truncated");
    }
}

} // namespace
} // namespace stromboli::images
