#pragma once

#include "host/film/film.hpp"
#include "scene/camera/camera.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

/// What a picture shows where no surface is: it lights nothing, and is seen through no glass.
struct Background {
    /// Linear radiance, row after row from the top; one texel: a colour.
    uint32_t width = 1, height = 1;
    std::vector<glm::vec3> radiance{glm::vec3(0)};
    std::vector<std::string> faults{}; ///< what is wrong with its picture, a line each
};

/// A picture of any format that environments have, which becomes as large as covers the frame,
/// with its middle in the frame's. Throws SceneError.
Background backgroundFrom(const std::string& file);

/// Puts the background behind the means of a film's pixels, of which `alpha` is the part that
/// surfaces cover.
void putBehind(Film& film, std::span<const float> alpha, const Background& background);

} // namespace stromboli
