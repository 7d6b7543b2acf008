#pragma once

#include "scene/images/picture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace stromboli::images {

/// Linear red, green and blue (Rec. 709 primaries), row after row from the top.
struct FloatImage {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> texels;
    std::vector<PictureFault> faults{};
    bool isEightBit = false; ///< of 8 bits a channel, which hold no light above 1
};

/// Reads a picture of any format of decodePicture as linear light, for environments. Pictures of 8
/// or 16 bits a channel are taken as sRGB; alpha is dropped. Numbers that are negative, infinite or
/// NaN become 0, which is a fault of the result; a picture of more than `largestSide` texels a side
/// is shrunk to means of its light, which is one too. Throws SceneError.
FloatImage readFloatImage(const std::filesystem::path& file, uint32_t largestSide = kLargestSide);

/// A picture of radiance, or a part of one.
struct RadiancePicture {
    uint32_t width = 0, height = 0;
    uint32_t left = 0, top = 0;               ///< of the part in the whole picture
    uint32_t wholeWidth = 0, wholeHeight = 0; ///< of the whole picture
    /// Linear red, green and blue (Rec. 709), multiplied by alpha, and alpha: 1 where the file says
    /// nothing of it. Row after row from the top; any number that a file of floats holds.
    std::vector<glm::vec4> texels;
    std::vector<PictureFault> faults{};

    /// Whether a texel is not quite covered.
    bool isTransparent() const;
};

/// Reads a picture of any format of decodePicture as linear light that is to be shown. Pictures of
/// 8 or 16 bits a channel are taken as sRGB. `layer`: of an OpenEXR file, as of decodeExrLayer();
/// empty: its picture. Throws SceneError.
RadiancePicture readRadiance(const std::filesystem::path& file, const std::string& layer = "");

} // namespace stromboli::images
