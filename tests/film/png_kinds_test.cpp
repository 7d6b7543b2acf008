#include "host/core/error.hpp"
#include "host/film/image_formats.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <fstream>

namespace stromboli {
namespace {

using testing::ElementsAre;

/// Writes a picture of `width` x 1 pixels in any of libpng's colour types.
void writeKind(const std::filesystem::path& path, int colourType, int bits, uint32_t width,
               std::vector<png_byte> row, const std::vector<png_color>& palette = {},
               std::vector<png_byte> paletteAlpha = {}) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, width, 1, bits, colourType, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    if (!paletteAlpha.empty())
        png_set_tRNS(png, info, paletteAlpha.data(), static_cast<int>(paletteAlpha.size()),
                     nullptr);
    png_write_info(png, info);
    png_write_row(png, row.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

class PngKinds : public testing::Test {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_ / "a.png";
};

TEST_F(PngKinds, PaletteOfTwoBitsIsExpanded) {
    writeKind(path_, PNG_COLOR_TYPE_PALETTE, 2, 3, {0b00'01'10'00},
              {{1, 2, 3}, {40, 50, 60}, {255, 0, 128}});
    EXPECT_THAT(readPng(path_).rgb, ElementsAre(1, 2, 3, 40, 50, 60, 255, 0, 128));
}

TEST_F(PngKinds, TransparentPaletteEntriesKeepTheirColour) {
    writeKind(path_, PNG_COLOR_TYPE_PALETTE, 8, 2, {0, 1}, {{1, 2, 3}, {40, 50, 60}}, {0, 128});
    EXPECT_THAT(readPng(path_).rgb, ElementsAre(1, 2, 3, 40, 50, 60));
}

TEST_F(PngKinds, AlphaIsDropped) {
    writeKind(path_, PNG_COLOR_TYPE_RGB_ALPHA, 8, 2, {10, 20, 30, 0, 40, 50, 60, 255});
    EXPECT_THAT(readPng(path_).rgb, ElementsAre(10, 20, 30, 40, 50, 60));
}

TEST_F(PngKinds, GreyIsExpanded) {
    writeKind(path_, PNG_COLOR_TYPE_GRAY, 1, 2, {0b10'000000});
    EXPECT_THAT(readPng(path_).rgb, ElementsAre(255, 255, 255, 0, 0, 0));
}

TEST_F(PngKinds, SixteenBitsAreScaled) {
    writeKind(path_, PNG_COLOR_TYPE_RGB, 16, 1, {0xFF, 0xFF, 0x80, 0x00, 0x00, 0x90});
    EXPECT_THAT(readPng(path_).rgb, ElementsAre(255, 128, 1));
}

TEST_F(PngKinds, WhatIsNoPictureIsAUsageErrorNamingTheFile) {
    std::ofstream(path_) << "not a picture";
    for (const std::filesystem::path& path : {path_, folder_ / "missing.png", folder_.path()}) {
        try {
            readPng(path);
            ADD_FAILURE() << path << " was read";
        } catch (const UsageError& error) {
            EXPECT_THAT(error.what(), testing::StartsWith(path.string() + ": cannot read"));
        }
        EXPECT_THROW(readExr(path), UsageError);
    }
}

TEST_F(PngKinds, AFileCutShortIsRefused) {
    writePng(path_, ByteImage(100, 100), PngColorSpace::Srgb);
    std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 30);
    EXPECT_THROW(readPng(path_), UsageError);
}

} // namespace
} // namespace stromboli
