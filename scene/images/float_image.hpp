#pragma once

#include "scene/images/picture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
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

} // namespace stromboli::images
