#include "host/core/error.hpp"
#include "scene/images/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <random>

namespace stromboli::images {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<uint8_t>;
using Words = std::vector<uint16_t>;
using Floats = std::vector<float>;

struct Memory {
    std::string bytes;
    uint64_t next = 0;
};

tmsize_t readFrom(thandle_t handle, void* to, tmsize_t count) {
    auto& memory = *static_cast<Memory*>(handle);
    const uint64_t left =
        memory.bytes.size() - std::min<uint64_t>(memory.next, memory.bytes.size());
    const auto read = size_t(std::min(uint64_t(count), left));
    std::memcpy(to, memory.bytes.data() + memory.next, read);
    memory.next += read;
    return tmsize_t(read);
}

tmsize_t writeTo(thandle_t handle, void* from, tmsize_t count) {
    auto& memory = *static_cast<Memory*>(handle);
    memory.bytes.resize(std::max<size_t>(memory.bytes.size(), memory.next + uint64_t(count)));
    std::memcpy(memory.bytes.data() + memory.next, from, size_t(count));
    memory.next += uint64_t(count);
    return count;
}

toff_t seekIn(thandle_t handle, toff_t offset, int from) {
    auto& memory = *static_cast<Memory*>(handle);
    return memory.next = offset + (from == SEEK_CUR   ? memory.next
                                   : from == SEEK_END ? memory.bytes.size()
                                                      : 0);
}

/// How a TIFF file is written; by default as one strip of whole numbers that are not packed.
struct Layout {
    uint32_t width = 1, height = 1;
    uint16_t samples = 3, bits = 8;
    uint16_t format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_RGB;
    uint16_t compression = COMPRESSION_NONE, orientation = 0, planar = PLANARCONFIG_CONTIG;
    int alpha = -1; ///< EXTRASAMPLE_..., of one sample
    uint32_t rowsInStrip = 1000, tile = 0;
    const char* mode = "w"; ///< of libtiff: "wb" for the other byte order
    std::function<void(TIFF*)> change{};
};

/// The bytes of a TIFF file of the given blocks: strips or tiles, each plane for itself.
template <class Value>
std::string tiff(const Layout& layout, std::vector<std::vector<Value>> blocks) {
    Memory memory;
    TIFF* file = TIFFClientOpen(
        "", layout.mode, &memory, readFrom, writeTo, seekIn, [](thandle_t) { return 0; },
        [](thandle_t handle) { return toff_t(static_cast<Memory*>(handle)->bytes.size()); },
        nullptr, nullptr);
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, layout.width);
    TIFFSetField(file, TIFFTAG_IMAGELENGTH, layout.height);
    TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, layout.samples);
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, layout.bits);
    TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, layout.format);
    TIFFSetField(file, TIFFTAG_PHOTOMETRIC, layout.photometric);
    TIFFSetField(file, TIFFTAG_COMPRESSION, layout.compression);
    TIFFSetField(file, TIFFTAG_PLANARCONFIG, layout.planar);
    if (layout.orientation) TIFFSetField(file, TIFFTAG_ORIENTATION, layout.orientation);
    const auto alpha = uint16_t(layout.alpha);
    if (layout.alpha >= 0) TIFFSetField(file, TIFFTAG_EXTRASAMPLES, 1, &alpha);
    if (layout.tile) {
        TIFFSetField(file, TIFFTAG_TILEWIDTH, layout.tile);
        TIFFSetField(file, TIFFTAG_TILELENGTH, layout.tile);
    } else {
        TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, layout.rowsInStrip);
    }
    if (layout.change) layout.change(file);
    for (uint32_t i = 0; i < blocks.size(); ++i) {
        const auto size = tmsize_t(blocks[i].size() * sizeof(Value));
        if (layout.tile)
            TIFFWriteEncodedTile(file, i, blocks[i].data(), size);
        else
            TIFFWriteEncodedStrip(file, i, blocks[i].data(), size);
    }
    TIFFClose(file);
    return memory.bytes;
}

template <class Values>
Values tiffValues(const std::string& bytes) {
    return std::get<Values>(decodePicture(bytes, "a.tif").values);
}

TEST(Tiff, OfEightBitsHoweverItIsPacked) {
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
                                  COMPRESSION_PACKBITS, COMPRESSION_ZSTD}) {
        const Layout layout{.width = 2, .compression = uint16_t(compression)};
        EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(layout, {{1, 2, 3, 250, 251, 252}})),
                    ElementsAre(1, 2, 3, 255, 250, 251, 252, 255))
            << compression;
    }
}

TEST(Tiff, OfSixteenBitsAndFloatsInEitherByteOrder) {
    for (const char* mode : {"wl", "wb", "w8"}) {
        EXPECT_THAT(
            tiffValues<Words>(tiff<uint16_t>({.bits = 16, .mode = mode}, {{1, 258, 65535}})),
            ElementsAre(1, 258, 65535, 65535));
        const Layout floats{.bits = 32, .format = SAMPLEFORMAT_IEEEFP, .mode = mode};
        EXPECT_THAT(tiffValues<Floats>(tiff<float>(floats, {{0.25f, 1e6f, -1}})),
                    ElementsAre(0.25f, 1e6f, -1, 1));
        const Layout halves{.bits = 16, .format = SAMPLEFORMAT_IEEEFP, .mode = mode};
        EXPECT_THAT(tiffValues<Floats>(tiff<uint16_t>(halves, {{0x3C00, 0x4000, 0x3800}})),
                    ElementsAre(1, 2, 0.5f, 1));
    }
}

TEST(Tiff, GreyIsThreeEqualColoursAndMayCountFromWhite) {
    const Layout black{.samples = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(black, {{7}})), ElementsAre(7, 7, 7, 255));
    const Layout white{.samples = 1, .photometric = PHOTOMETRIC_MINISWHITE};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(white, {{7}})), ElementsAre(248, 248, 248, 255));
}

TEST(Tiff, AlphaIsNoPartOfColours) {
    const Layout plain{.samples = 4, .alpha = EXTRASAMPLE_UNASSALPHA};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(plain, {{100, 50, 0, 51}})),
                ElementsAre(100, 50, 0, 51));
    // By which such files multiply colours: 51 is a fifth.
    const Layout multiplied{.samples = 4, .alpha = EXTRASAMPLE_ASSOCALPHA};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(multiplied, {{20, 10, 0, 51}})),
                ElementsAre(100, 50, 0, 51));
}

/// The second of two tiles of 16 x 16 has one column of a picture of 17 x 1 pixels.
TEST(Tiff, TilesMayReachBeyondThePicture) {
    Bytes first(16 * 16 * 3, 10), second(16 * 16 * 3, 99);
    second[0] = 1, second[1] = 2, second[2] = 3;
    const Bytes values = tiffValues<Bytes>(
        tiff<uint8_t>({.width = 17, .compression = COMPRESSION_LZW, .tile = 16}, {first, second}));
    ASSERT_EQ(values.size(), 17u * 4);
    EXPECT_THAT(Bytes(values.begin() + 60, values.end()),
                ElementsAre(10, 10, 10, 255, 1, 2, 3, 255));
}

TEST(Tiff, ColoursMayStandInPlanes) {
    const Layout layout{.width = 2, .planar = PLANARCONFIG_SEPARATE};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(layout, {{1, 4}, {2, 5}, {3, 6}})),
                ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
}

/// Two rows of two pixels are 1, 2, 3, 4 in the file; the table has what is seen from the top left.
TEST(Tiff, OrientationSaysWhereTheFirstRowIs) {
    const std::vector<std::array<int, 4>> seen = {{1, 2, 3, 4}, {2, 1, 4, 3}, {4, 3, 2, 1},
                                                  {3, 4, 1, 2}, {1, 3, 2, 4}, {3, 1, 4, 2},
                                                  {4, 2, 3, 1}, {2, 4, 1, 3}};
    for (size_t i = 0; i < seen.size(); ++i) {
        const Layout layout{.width = 2,
                            .height = 2,
                            .samples = 1,
                            .photometric = PHOTOMETRIC_MINISBLACK,
                            .orientation = uint16_t(i + 1)};
        const Bytes values = tiffValues<Bytes>(tiff<uint8_t>(layout, {{1, 2, 3, 4}}));
        for (size_t texel = 0; texel < 4; ++texel)
            EXPECT_EQ(values[4 * texel], seen[i][texel]) << i + 1 << ' ' << texel;
    }
    const Picture wide =
        decodePicture(tiff<uint8_t>({.width = 3, .orientation = 6}, {Bytes(9, 1)}), "a.tif");
    EXPECT_EQ(wide.width, 1u);
    EXPECT_EQ(wide.height, 3u);
}

TEST(Tiff, PalettesAndBits) {
    Words red(256), green(256), blue(256);
    red[3] = 65535, green[3] = 257 * 20, blue[3] = 257 * 30;
    const Layout palette{
        .samples = 1, .photometric = PHOTOMETRIC_PALETTE, .change = [&](TIFF* file) {
            TIFFSetField(file, TIFFTAG_COLORMAP, red.data(), green.data(), blue.data());
        }};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(palette, {{3}})), ElementsAre(255, 20, 30, 255));
    const Layout bits{.width = 2, .samples = 1, .bits = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    EXPECT_THAT(tiffValues<Bytes>(tiff<uint8_t>(bits, {{0x40}})),
                ElementsAre(0, 0, 0, 255, 255, 255, 255, 255));
}

/// Strips that are there are shown, and what is missing is mid grey.
TEST(Tiff, ThatIsDamagedIsShownAsFarAsItGoes) {
    std::string whole = tiff<uint8_t>(
        {.width = 3, .height = 2, .compression = COMPRESSION_ADOBE_DEFLATE, .rowsInStrip = 1},
        {Bytes(9, 5), Bytes(9, 6)});
    const size_t second = whole.find("\x78\x9c", whole.find("\x78\x9c") + 1);
    ASSERT_NE(second, std::string::npos);
    whole[second + 2] = char(0xFF);
    const Picture picture = decodePicture(whole, "a.tif");
    const auto& values = std::get<Bytes>(picture.values);
    EXPECT_EQ(values.at(0), 5);
    EXPECT_EQ(values.at(12), 127);
    ASSERT_EQ(picture.faults.size(), 1u);
    EXPECT_EQ(picture.faults[0].kind, build::Shortfall::PicturePart);
}

std::string tiffMessage(const std::string& bytes) {
    try {
        decodePicture(bytes, "a.tif");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "none";
}

TEST(Tiff, WhatIsNotReadIsSaid) {
    EXPECT_THAT(tiffMessage("II*" + std::string(5, '\0')), HasSubstr("cannot be read as TIFF"));
    const std::string whole = tiff<uint8_t>({.width = 64, .height = 64}, {Bytes(64 * 64 * 3, 9)});
    EXPECT_THAT(tiffMessage(whole.substr(0, whole.size() / 2)),
                HasSubstr("cannot be read as TIFF"));
    const Layout negative{.samples = 1,
                          .bits = 16,
                          .format = SAMPLEFORMAT_INT,
                          .photometric = PHOTOMETRIC_MINISBLACK};
    EXPECT_THAT(tiffMessage(tiff<int16_t>(negative, {{-3}})), HasSubstr("its numbers are neither"));
    const Layout wide{.width = 100000, .samples = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    EXPECT_THAT(tiffMessage(tiff<uint8_t>(wide, {Bytes(100000)})), HasSubstr("100000 x 1 pixels"));
}

TEST(Tiff, DamagedOnesNeverCrash) {
    std::mt19937 random(3);
    Bytes noise(16 * 16 * 3);
    for (uint8_t& value : noise)
        value = uint8_t(random());
    const std::string files[] = {
        tiff<uint8_t>({.width = 16, .height = 16, .compression = COMPRESSION_LZW}, {noise}),
        tiff<uint8_t>({.width = 16, .height = 16, .compression = COMPRESSION_JPEG}, {noise}),
        tiff<uint8_t>({.width = 15, .height = 9, .tile = 16}, {noise}),
        tiff<uint8_t>({.width = 16, .height = 16, .photometric = PHOTOMETRIC_YCBCR}, {noise})};
    for (const std::string& file : files)
        for (int i = 0; i < 500; ++i) {
            std::string damaged = file;
            for (int j = 0; j < 3; ++j) {
                // Where the directory is, most is decided.
                const size_t end = damaged.size(), part = random() % 2 ? end : 200;
                damaged[end - 1 - random() % part] = char(random());
            }
            EXPECT_THAT(tiffMessage(damaged), testing::Not(HasSubstr("\n")));
        }
}

} // namespace
} // namespace stromboli::images
