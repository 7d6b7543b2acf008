#pragma once

#include "host/stress/run.hpp"

#include <vector>

namespace stromboli::stress {

/// A texture (into Scene::textures) asked at a point.
struct Lookup {
    uint32_t texture = 0;
    glm::vec2 uv{0.0f};
};

/// What the subject finds, in the order of the lookups: red, green, blue. One picture: each lookup
/// is the emission of a square that fills one pixel and has the same coordinates at all corners.
/// NaN where a pixel has no sample. textures: a scene with images and textures alone.
std::vector<glm::dvec3> lookUpInPicture(Run& run, const Scene& textures,
                                        const std::vector<Lookup>& lookups);

} // namespace stromboli::stress
