#pragma once

#include "host/film/picture_area.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace stromboli {

/// What a picture's file says about the picture in words: text chunks of PNG, string attributes of
/// EXR.
struct PictureNote {
    std::string name; ///< 1 to 31 letters and digits of ASCII: PNG allows 79, EXR 31
    std::string text; ///< UTF-8 without NUL

    friend bool operator==(const PictureNote&, const PictureNote&) = default;
};
using PictureNotes = std::vector<PictureNote>;

/// 8-bit picture: rows from the top, three bytes (R, G, B) per pixel.
struct ByteImage {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
    /// One byte per pixel, by which rgb is not multiplied; empty: all is opaque.
    std::vector<uint8_t> alpha;

    ByteImage() = default;
    ByteImage(uint32_t w, uint32_t h) : width(w), height(h), rgb(size_t(w) * h * 3) {}
    uint8_t* pixel(uint32_t x, uint32_t y) { return &rgb[(size_t(y) * width + x) * 3]; }
    const uint8_t* pixel(uint32_t x, uint32_t y) const { return &rgb[(size_t(y) * width + x) * 3]; }
};

/// Linear picture, or a part of one: named channels ("R", "G", "B", ...), each with width * height
/// values, rows from the top.
struct FloatImage {
    uint32_t width = 0, height = 0; ///< of the part
    PictureArea area;               ///< where the part lies in the whole picture
    std::map<std::string, std::vector<float>> channels;
    uint32_t branches = 1; ///< paths of each sample that the channel "samples" counts by paths

    FloatImage() = default;
    explicit FloatImage(const PictureArea& a)
        : width(a.rendered().width), height(a.rendered().height), area(a) {}
    FloatImage(uint32_t w, uint32_t h) : FloatImage(PictureArea{w, h, {}}) {}
    /// The channel of that name, made (all 0) if there is none.
    std::vector<float>& channel(const std::string& name);
};

} // namespace stromboli
