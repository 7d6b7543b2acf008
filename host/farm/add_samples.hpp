#pragma once

#include "host/film/shared_pixel.hpp"
#include "host/render/backend.hpp"

#include <span>

namespace stromboli {

/// Adds what a backend has taken of the targets, from number `firstSample` of each pixel on, as
/// part of pass number `pass`. Throws SceneError if a radiance is out of range.
void addSamples(std::span<SharedPixel> pixels, std::span<const PixelTarget> targets,
                const Film& taken, uint32_t firstSample, uint32_t pass);

} // namespace stromboli
