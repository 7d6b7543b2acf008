#pragma once

#include "scene/mitsuba/context.hpp"
#include "scene/model/medium.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace stromboli::mitsuba {

/// A number or colour that may differ from place to place.
struct Volume {
    glm::dvec3 mean{0.0};
    std::optional<DensityGrid> grid; ///< none: it is `mean` everywhere; toUnit is left open
    std::optional<ColorGrid> colors; ///< likewise, of three channels; `grid` has their means
    glm::dmat4 toFile{1.0};          ///< from the grid's unit cube to the file's world
};

/// Throws SceneError for one that cannot be read.
Volume readVolume(const Context& context, const Plugin& volume);

/// The box that a grid's file says it fills, and its values; those of several channels become their
/// means.
struct VolumeFile {
    DensityGrid grid;
    std::optional<ColorGrid> colors; ///< of three channels
    glm::dvec3 low{0.0}, high{1.0};
    glm::dvec3 mean{0.0}; ///< by channel
};

/// Mitsuba's format of volumes (version 3). Values below 0 become 0 unless they have a meaning.
/// Throws SceneError with `name`.
VolumeFile parseVolume(std::string_view bytes, const std::string& name, bool keepsSigns = false);

} // namespace stromboli::mitsuba
