#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/textures.hpp"

namespace stromboli::mitsuba {

// Mesh attributes as pictures: each triangle has two by two texels of its own, of which three are
// the values at its corners and the fourth continues them, so that bilinear lookups between their
// middles are the interpolation between corners, and the second texture coordinates of corners are
// these middles.

/// The colours of the mesh's corners, triangle by triangle.
TextureImage paintOfCorners(const build::Mesh& mesh, const Paint& paint);
/// Gives all corners attributes of their own, with the coordinates of such a picture.
void spreadCorners(build::Mesh& mesh);

} // namespace stromboli::mitsuba
