#pragma once

#include "scene/build/mesh.hpp"
#include "scene/model/scene.hpp"

#include <cstddef>

namespace stromboli::build {

/// Colours of corners are fractions of light: what is outside [0, 1] or no number becomes the
/// nearest in it (0 of NaN). Returns how many colours there were.
size_t clampColors(std::vector<VertexAttributes>& attributes);

/// Texels of base colours that would make a surface reflect more than it receives become the most
/// that it can; negative ones become 0. A picture that is used for something else too is copied.
/// Returns how many texels there were.
size_t clampBaseColors(Scene& scene);

} // namespace stromboli::build
