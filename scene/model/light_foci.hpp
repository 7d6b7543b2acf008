#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace stromboli {

struct Scene;

/// A lamp as it is seen from afar, for drawing distances about it (docs/theory/media.md, "Lamps
/// that are near").
struct LightFocus {
    glm::dvec3 point{0.0};
    double radius = 0;    ///< of a sphere about it that holds the lamp; > 0
    double intensity = 0; ///< luminance of the mean over all directions, power / (4 pi)
    double radiance = 0;  ///< luminance of the mean that its surface sends out; 0: it has none
};

struct LightFoci {
    std::vector<LightFocus> near; ///< the brightest first, kMostFoci at most
    double others = 0;            ///< radiance that other lights give to a white surface, roughly
};

inline constexpr size_t kMostFoci = 4;

/// Point lights, spots, projectors and emitters that are so small beside the free path of a medium
/// of the scene that drawing by its extinction finds too few points about them: 4 pi times radius
/// times extinction is below 1 (docs/theory/media.md). Those that lie together count as one. None
/// where no medium that is the same everywhere scatters. Takes time in proportion to the emissive
/// triangles and the environment's picture.
LightFoci lightFoci(const Scene& scene);

} // namespace stromboli
