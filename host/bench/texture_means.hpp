#pragma once

#include "scene/model/scene.hpp"

namespace stromboli::bench {

/// The scene with the mean of each texture in its place: of base colours and metallic-roughness;
/// other textures are left out. A surface whose opacity has a texture blends with its mean opacity,
/// also where it is a mask, which by a mean would be there everywhere or nowhere.
Scene withMeans(Scene scene);

} // namespace stromboli::bench
