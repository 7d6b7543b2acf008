#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace stromboli::images {

/// Linear red, green and blue (Rec. 709 primaries), row after row from the top.
struct FloatImage {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> texels;
};

/// Reads a picture of any format of decodePicture as linear light, for environments. Pictures of 8
/// or 16 bits a channel are taken as sRGB; alpha is dropped. Throws SceneError, also for values
/// that are negative, infinite or NaN, with the pixel that has one.
FloatImage readFloatImage(const std::filesystem::path& file);

} // namespace stromboli::images
