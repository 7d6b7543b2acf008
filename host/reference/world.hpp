#pragma once

#include "host/reference/bvh.hpp"
#include "host/reference/lights.hpp"

namespace stromboli::reference {

/// What paths are traced through. Refers to the scene, which must outlive it.
struct World {
    const Scene& scene;
    Convention convention;
    Bvh bvh;
    Lights lights;

    World(const Scene& s, Convention c) : scene(s), convention(c), bvh(s), lights(s, c) {}
};

} // namespace stromboli::reference
