// "Technical Introduction to OpenEXR", sections "Luminance/Chroma Images", "CIE xy Chromaticities"
// and "Environment Maps".

#include "scene/images/exr_colors.hpp"

#include "host/core/chromaticity.hpp"

#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfRgbaYca.h>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace stromboli::images {
namespace {

/// OpenEXR multiplies rows by matrices, glm columns, and each stores what the other transposes.
glm::dmat3 columnsOf(const Imath::M44f& m) {
    glm::dmat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            result[i][j] = double(m[i][j]);
    return result;
}

Imf::Chromaticities primariesOf(const std::array<float, 8>& xy) {
    return {{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}};
}

glm::dvec3 whiteOf(const Imf::Chromaticities& c) {
    return xyzOf(Chromaticity{double(c.white.x), double(c.white.y)});
}

bool isFinite(const glm::dmat3& m) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!std::isfinite(m[i][j])) return false;
    return true;
}

/// The texel of one face of a cube that a direction meets, between the middles of its texels.
glm::vec4 onCube(const Imath::Box2i& window, const Picture& picture, const glm::dvec3& direction) {
    const std::vector<float>& values = std::get<std::vector<float>>(picture.values);
    Imf::CubeMapFace face{};
    Imath::V2f place;
    Imf::CubeMap::faceAndPixelPosition({float(direction.x), float(direction.y), float(direction.z)},
                                       window, face, place);
    const int last = Imf::CubeMap::sizeOfFace(window) - 1;
    const glm::vec2 inside =
        glm::clamp(glm::vec2(place.x, place.y), glm::vec2(0), glm::vec2(float(last)));
    const glm::ivec2 first(inside);
    const glm::vec2 part = inside - glm::vec2(first);
    glm::vec4 sum(0);
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 at = glm::min(first + glm::ivec2(k & 1, k >> 1), glm::ivec2(last));
        const float weight =
            ((k & 1) != 0 ? part.x : 1 - part.x) * ((k >> 1) != 0 ? part.y : 1 - part.y);
        const Imath::V2f pixel =
            Imf::CubeMap::pixelPosition(face, window, {float(at.x), float(at.y)});
        const auto x = uint32_t(std::lround(pixel.x)) - uint32_t(window.min.x);
        const auto y = uint32_t(std::lround(pixel.y)) - uint32_t(window.min.y);
        const size_t texel = (size_t(std::min(y, picture.height - 1)) * picture.width +
                              std::min(x, picture.width - 1)) *
                             4;
        for (int channel = 0; channel < 4; ++channel)
            sum[channel] += weight * values[texel + size_t(channel)];
    }
    return sum;
}

Picture unfolded(const Picture& cube) {
    const uint32_t face = cube.width;
    const Imath::Box2i window({0, 0}, {int(cube.width) - 1, int(cube.height) - 1});
    Picture picture{std::min(4 * face, kLargestSide), std::min(2 * face, kLargestSide / 2), {}};
    std::vector<float> values(picture.texelCount() * 4);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const double theta = glm::pi<double>() * (y + 0.5) / picture.height;
            const double phi = 2 * glm::pi<double>() * (x + 0.5) / picture.width;
            // The middle column is -z, and three quarters of the way is +x.
            const glm::dvec3 direction(-std::sin(theta) * std::sin(phi), std::cos(theta),
                                       std::sin(theta) * std::cos(phi));
            const glm::vec4 texel = onCube(window, cube, direction);
            for (int channel = 0; channel < 4; ++channel)
                values[(size_t(y) * picture.width + x) * 4 + size_t(channel)] = texel[channel];
        }
    picture.values = std::move(values);
    return picture;
}

/// In OpenEXR's maps the middle column is +z, here it is -z.
void turnHalfway(Picture& picture) {
    std::vector<float>& values = std::get<std::vector<float>>(picture.values);
    const size_t row = size_t(picture.width) * 4;
    for (uint32_t y = 0; y < picture.height; ++y) {
        const auto begin = values.begin() + ptrdiff_t(y * row);
        std::rotate(begin, begin + ptrdiff_t(picture.width / 2 * 4), begin + ptrdiff_t(row));
    }
}

} // namespace

void colorsOfLuminance(const ExrMeaning& meaning, std::vector<float>& rgba) {
    const Imath::V3f weights = Imf::RgbaYca::computeYw(
        meaning.chromaticities ? primariesOf(*meaning.chromaticities) : Imf::Chromaticities());
    for (size_t i = 0; i < rgba.size(); i += 4) {
        const float y = rgba[i];
        const float red = (rgba[i + 1] + 1) * y, blue = (rgba[i + 2] + 1) * y;
        rgba[i] = red;
        rgba[i + 1] = (y - red * weights.x - blue * weights.z) / weights.y;
        rgba[i + 2] = blue;
    }
}

void toRec709(const ExrMeaning& meaning, std::vector<float>& rgba) {
    if (!meaning.chromaticities) return;
    const Imf::Chromaticities stated = primariesOf(*meaning.chromaticities), own;
    const auto isNear = [](const Imath::V2f& a, const Imath::V2f& b) {
        return (a - b).length() < 1e-4f; // files round them to four digits
    };
    if (isNear(stated.red, own.red) && isNear(stated.green, own.green) &&
        isNear(stated.blue, own.blue) && isNear(stated.white, own.white))
        return;
    const glm::dmat3 matrix = columnsOf(Imf::XYZtoRGB(own, 1)) *
                              chromaticAdaptation(whiteOf(stated), whiteOf(own)) *
                              columnsOf(Imf::RGBtoXYZ(stated, 1));
    if (!isFinite(matrix)) return; // no primaries span a space of no size
    for (size_t i = 0; i < rgba.size(); i += 4) {
        // Colours beyond Rec. 709 have a negative channel, which no light has.
        const glm::dvec3 color =
            glm::max(matrix * glm::dvec3(rgba[i], rgba[i + 1], rgba[i + 2]), glm::dvec3(0));
        for (int channel = 0; channel < 3; ++channel)
            rgba[i + size_t(channel)] = float(color[channel]);
    }
}

Picture asEnvironment(const ExrMeaning& meaning, Picture picture) {
    if (meaning.isLatLong) turnHalfway(picture);
    if (!meaning.isCube || picture.height / 6 != picture.width || picture.width < 2) return picture;
    Picture unfold = unfolded(picture);
    unfold.faults = std::move(picture.faults);
    return unfold;
}

} // namespace stromboli::images
