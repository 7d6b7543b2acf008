#pragma once

#include "host/reference/bvh.hpp"
#include "host/reference/lights.hpp"

#include <algorithm>

namespace stromboli::reference {

/// What paths are traced through. Refers to the scene, which must outlive it.
struct World {
    const Scene& scene;
    ShadingConventions conventions;
    Bvh bvh;
    Lights lights;
    bool hasDetails; ///< materials have textures, or corners have attributes
    bool hasAlpha;   ///< some surface may be partly not there, or hidden from the camera

    World(const Scene& s, const ShadingConventions& c)
        : scene(s), conventions(c), bvh(s), lights(s, c),
          hasDetails(!s.textures.empty() || !s.attributes.empty()),
          hasAlpha(std::ranges::any_of(s.materials, [](const Material& m) {
              return m.alphaMode != AlphaMode::Opaque || m.isHiddenFromCamera;
          })) {}
};

} // namespace stromboli::reference
