#pragma once

#include "scene/images/picture.hpp"

#include <array>
#include <optional>
#include <vector>

namespace stromboli::images {

/// What a header says of colours and directions.
struct ExrMeaning {
    /// x and y of red, green, blue and white.
    std::optional<std::array<float, 8>> chromaticities;
    bool isLatLong = false, isCube = false; ///< its envmap
};

/// Luminance and chroma, (Y, RY, BY) in place of red, green and blue, become colours.
void colorsOfLuminance(const ExrMeaning& meaning, std::vector<float>& rgba);

/// Colours of the header's primaries become those of Rec. 709. White stays white: where the white
/// points differ, cones adapt (Lam 1985, "Bradford").
void toRec709(const ExrMeaning& meaning, std::vector<float>& rgba);

/// A picture whose header calls it a cube, or a map of directions by latitude and longitude, as an
/// environment of this program (scene/model/environment.hpp): OpenEXR's directions are those of the
/// world, y up.
Picture asEnvironment(const ExrMeaning& meaning, Picture picture);

} // namespace stromboli::images
