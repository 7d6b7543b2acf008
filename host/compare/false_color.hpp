#pragma once

#include "host/compare/picture.hpp"
#include "host/film/image_file.hpp"

#include <cstdint>
#include <span>

namespace stromboli::compare {

/// Cubehelix (Green 2011; start 0.5, -1.5 rotations, hue 1, gamma 1): 0 is black, 1 is white, and
/// the lightness grows evenly between, so that the picture reads in grey too. Clamps its argument.
glm::dvec3 cubehelix(double value);

/// -1 is blue, 0 is white, 1 is red, linear in between. Clamps its argument.
glm::dvec3 blueWhiteRed(double value);

/// One value a pixel through cubehelix(value / top).
ByteImage falseColor(std::span<const double> values, uint32_t width, uint32_t height, double top);

/// (x - r) / (r + 0.1 m) in luminance, m the mean of the reference, through blueWhiteRed: red
/// where the picture is too bright; the ends of the colours are at -1 and 1.
ByteImage signedDifference(const Picture& reference, const Picture& picture);

} // namespace stromboli::compare
