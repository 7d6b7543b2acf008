#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/report.hpp"

namespace stromboli::bench {

bool hasTextures(const Scene& scene);

/// What textures cost: the scene, and the same one with the mean of each texture in its place, by
/// ray. Normal maps are replaced by none; a surface whose opacity has a texture blends with the
/// share of its texels that light meets, masks too. Both are lit by the bundled sky; what emits by
/// a texture emits in neither, since with a mean all of it would be a light.
TextureReport benchTextures(const Arena& arena);

} // namespace stromboli::bench
