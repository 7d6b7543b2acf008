#pragma once

#include "host/reference/world.hpp"
#include "host/render/layers.hpp"

namespace stromboli::reference {

/// The share of light that meets the surface at a hit.
double opacityAt(const World& world, const Hit& hit);

/// The first hit that is there: of what is partly there, decided by numbers of `passes`.
Hit closestThere(const World& world, const Ray& ray, Skip skip, RandomStream& passes);
/// The same for camera rays, which pass what is hidden from the camera.
Hit closestForCamera(const World& world, const Ray& ray, RandomStream& passes);

/// Adds what one camera ray of a pixel sees (docs/layers.md). `random`: the stream of its sample,
/// as the camera has left it; weight: by the pixel filter.
void addSeen(SeenPixel& pixel, const World& world, const Ray& cameraRay, double weight,
             RandomStream random, Seeing what);

} // namespace stromboli::reference
