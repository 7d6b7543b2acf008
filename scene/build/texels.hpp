#pragma once

#include "scene/model/texture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace stromboli::build {

/// Which numbers of a texel a picture's value becomes; the others are 1. Grey: red, in the
/// precision of the file where that has no colours.
enum class Layout { Color, Alpha, Red, Green, Blue, GreenAndBlue, Grey };

/// Adds a texel that holds a value where the layout says, of RgbaHalf.
void appendTexel(std::vector<uint32_t>& words, const glm::dvec3& value, Layout layout);

/// The texel number i, of linear light where it is sRGB.
glm::dvec3 colorAt(const TextureImage& image, size_t i, bool srgb);
/// Each texel with its value where the layout says.
TextureImage rearranged(const TextureImage& image, bool srgb, Layout layout);
/// Each texel with the mean of its channels.
TextureImage ofMeans(const TextureImage& image, bool srgb);
/// Of 8 bits, each number raised to a power, as linear light.
TextureImage decodedBy(const TextureImage& image, double power);
/// Channels of a texel differ.
bool isColored(const TextureImage& image, bool srgb);
/// It has no colours.
bool isGrey(const TextureImage& image);
/// Drops the alpha, as Mitsuba does.
void makeOpaque(TextureImage& image);
/// One channel, 0 to 3, takes the place of all colours.
void spreadChannel(TextureImage& image, int channel);

} // namespace stromboli::build
