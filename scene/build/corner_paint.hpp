#pragma once

#include "scene/build/mesh.hpp"
#include "scene/build/texels.hpp"

#include <vector>

namespace stromboli::build {

// Colours of corners as pictures: each triangle has two by two texels of its own, of which three
// are the values at its corners and the fourth continues them, so that bilinear lookups between
// their middles are the interpolation between corners, and texture coordinates of corners are these
// middles.

/// The colours of a part's corners, triangle by triangle; white where a corner has none.
/// isFraction: they are clamped to [0, 1].
TextureImage paintOfCorners(const std::vector<VertexAttributes>& attributes, const MeshPart& part,
                            Layout layout, bool isFraction);
/// Gives all corners of a part attributes of their own, which are copies of `from` but for the
/// coordinates of such a picture in the set uvSet, and returns them; corners name them by numbers
/// from `first` on.
std::vector<VertexAttributes> spreadCorners(const std::vector<VertexAttributes>& from,
                                            MeshPart& part, uint32_t uvSet, size_t first);

} // namespace stromboli::build
