#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/report.hpp"

namespace stromboli::bench {

bool hasTextures(const Scene& scene);

/// What textures cost: the scene, and the same one with the mean of each texture in its place
/// (texture_means.hpp), by ray. Both are lit by the bundled sky; what emits by a texture emits in
/// neither, since with a mean all of it would be a light.
TextureReport benchTextures(const Arena& arena);

} // namespace stromboli::bench
