#pragma once

#include "host/reference/bvh.hpp"
#include "host/reference/lights.hpp"

namespace stromboli::reference {

/// What paths are traced through. Refers to the scene, which must outlive it.
struct World {
    const Scene& scene;
    ShadingConventions conventions;
    Bvh bvh;
    Lights lights;

    World(const Scene& s, const ShadingConventions& c)
        : scene(s), conventions(c), bvh(s), lights(s, c) {}
};

} // namespace stromboli::reference
