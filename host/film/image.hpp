#pragma once

#include "host/film/film.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace stromboli {

/// Picture of whole numbers, for a screen: rows from the top, three of them (R, G, B) per pixel.
template <class Value>
struct ScreenImage {
    uint32_t width = 0, height = 0;
    std::vector<Value> rgb;
    /// One number per pixel, by which rgb is not multiplied; empty: all is opaque.
    std::vector<Value> alpha;

    ScreenImage() = default;
    ScreenImage(uint32_t w, uint32_t h) : width(w), height(h), rgb(size_t(w) * h * 3) {}
    Value* pixel(uint32_t x, uint32_t y) { return &rgb[(size_t(y) * width + x) * 3]; }
    const Value* pixel(uint32_t x, uint32_t y) const { return &rgb[(size_t(y) * width + x) * 3]; }
};
using ByteImage = ScreenImage<uint8_t>;
/// 16 bits a channel.
using WordImage = ScreenImage<uint16_t>;

/// The channels of linear pictures that are red, green and blue.
inline constexpr const char* kColorChannels[] = {"R", "G", "B"};
/// The channel of the share of a pixel that is covered, by which colours are multiplied.
inline constexpr const char* kAlphaChannel = "A";

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
    std::vector<float>& channel(const std::string& name) {
        return channels.try_emplace(name, size_t(width) * height).first->second;
    }
};

} // namespace stromboli
