#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// How much of what the camera sees is to be found out.
enum class Seeing {
    Coverage, ///< whether there is a surface
    Surfaces, ///< all of SeenPixel
};

inline constexpr uint32_t kNothingSeen = 0xFFFFFFFFu;

/// What the camera rays of a pixel have found: sums over these rays (docs/layers.md).
struct SeenPixel {
    uint32_t samples = 0;     ///< camera rays
    uint32_t hits = 0;        ///< those of them that end on a surface
    double covered = 0;       ///< the sum of the weights that these have by the pixel filter
    glm::dvec3 albedo{0.0};   ///< of what is seen, also in mirrors and through glass
    glm::dvec3 normal{0.0};   ///< likewise; unit vectors of the world
    glm::dvec3 position{0.0}; ///< of the hits
    /// Of the first ray that has hit something: what, in the scene's order (triangles, then
    /// spheres), and where on it: barycentric weights of the second and third corner.
    uint32_t primitive = kNothingSeen;
    uint32_t placement = kNothingSeen; ///< that it is in, of a prototype's triangle
    double b1 = 0, b2 = 0;

    double coverage() const { return samples == 0 ? 0 : covered / samples; }
};

/// Traces camera rays without light: a backend, for the picture that it was made for.
class Viewer {
  public:
    virtual ~Viewer() = default;
    /// Of pixels that follow each other, from `first` on (Film::pixels): samples[i] camera rays of
    /// each, from that of sample `firstSample` on, to the last bit those that Backend::sample()
    /// takes. No more than kMostSeenAtOnce pixels.
    virtual std::vector<SeenPixel> see(uint32_t first, std::span<const uint32_t> samples,
                                       Seeing what, uint32_t firstSample = 0) = 0;

    static constexpr uint32_t kMostSeenAtOnce = 1u << 16; ///< 4 MiB on the device
};

} // namespace stromboli
