#pragma once

#include "host/core/text.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::view {

/// What a page can show of a picture, by the names that its requests have.
enum class Shown { Picture, Denoised, Albedo, Normal, Depth, Noise, Samples };

} // namespace stromboli::view

namespace stromboli {
template <>
inline constexpr auto kNamedValues<view::Shown> = std::to_array<NamedValue<view::Shown>>({
    {view::Shown::Picture, "picture", "radiance, as the samples have it"},
    {view::Shown::Denoised, "denoised", "radiance without its noise"},
    {view::Shown::Albedo, "albedo", "colour in white light"},
    {view::Shown::Normal, "normal", "shading normal"},
    {view::Shown::Depth, "depth", "metres along the camera's axis"},
    {view::Shown::Noise, "noise", "standard error of a pixel's mean, relative to the mean"},
    {view::Shown::Samples, "samples", "samples taken"},
});
} // namespace stromboli

namespace stromboli::view {

/// A picture as a page shows it: `channels` numbers for each pixel, rows from the top.
struct Raster {
    uint32_t width = 0, height = 0, channels = 0;
    std::vector<float> values;
};

/// The half float (IEEE 754 binary16) nearest to the number, to even where two are; infinite above
/// the largest, 65504. NaN becomes 0.
uint16_t halfOf(float value);

/// The e for which all finite values, divided by 2^e, fit a half float without losing precision at
/// the bright end: 0 unless the largest of them is above 32768 or all are below 1/256.
int exponentFor(std::span<const float> values);

/// The bytes that a page is sent: the length of the text in four bytes, the text, which is JSON,
/// padded with a blank to an even length, and the values divided by 2^exponent as half floats; all
/// in little-endian order.
std::string encodeFrame(std::string json, const Raster& raster, int exponent);

} // namespace stromboli::view
