#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace stromboli::reference {

// --- Intersection --------------------------------------------------------------------------------

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Unit round-off of double.
inline constexpr double kRoundoff = 0x1p-53;
inline constexpr uint32_t kNoPrimitive = 0xFFFFFFFFu;

/// Hits count for tMin < t < tMax.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0, 0, -1}; ///< unit
    double tMin = 0, tMax = kInfinity;
};

/// Where a ray meets a primitive. Triangles: the point is (1 - b1 - b2) v0 + b1 v1 + b2 v2.
struct Hit {
    double t = kInfinity;
    uint32_t primitive = kNoPrimitive; ///< triangles first, then spheres, in the scene's order
    double b1 = 0, b2 = 0;
};

/// Both sides count, edges belong to the triangle. `primitive` of the result is not set.
/// Moeller and Trumbore 1997, without a threshold for the determinant: triangles of any size can
/// be hit, and those of no area cannot.
std::optional<Hit> intersectTriangle(const Ray& ray, const glm::dvec3& v0, const glm::dvec3& v1,
                                     const glm::dvec3& v2);

/// The nearer of the two hits that lies within the ray. `primitive` of the result is not set.
std::optional<Hit> intersectSphere(const Ray& ray, const glm::dvec3& center, double radius);

// --- Traversal -----------------------------------------------------------------------------------

/// A primitive that a ray cannot hit: the triangle it starts on, the emitter it ends on.
struct Skip {
    uint32_t first = kNoPrimitive, second = kNoPrimitive;
    bool operator()(uint32_t primitive) const { return primitive == first || primitive == second; }
};

/// Bounding volume hierarchy of a scene's triangles and spheres, split by the surface area
/// heuristic over bins of centroids (Wald 2007). Refers to the scene, which must outlive it.
class Bvh {
  public:
    explicit Bvh(const Scene& scene);

    /// The hit with the smallest t; `primitive` is kNoPrimitive for none.
    Hit closest(const Ray& ray, Skip skip) const;
    /// The first hit behind one that the ray has passed; the first of all if that is none. Hits are
    /// ordered by t, and by primitive where t is the same, so that going on from hit to hit meets
    /// each of them once.
    Hit closestBehind(const Ray& ray, const Hit& passed, Skip skip) const;
    /// Whether there is any hit.
    bool occluded(const Ray& ray, Skip skip) const;

  private:
    struct Box {
        glm::dvec3 lo{kInfinity}, hi{-kInfinity};
        void extend(const Box& other);
        double halfArea() const;
    };
    struct Node {
        Box box;
        uint32_t first = 0; ///< leaf: into order_; inner: the left child, the right one follows it
        uint32_t count = 0; ///< 0 for inner nodes
    };
    struct Range {
        uint32_t begin = 0, end = 0;
    };

    Box boxOf(uint32_t primitive) const;
    void build(uint32_t node, Range range, unsigned depth);
    uint32_t split(Range range, const Box& box, unsigned depth);
    uint32_t splitAtMedian(Range range, int axis);
    std::optional<Hit> intersect(const Ray& ray, uint32_t primitive) const;
    template <class Visit>
    void traverse(const Ray& ray, Visit&& visit) const;

    const Scene& scene_;
    std::vector<Box> boxes_; ///< of the primitives; empty once built
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace stromboli::reference
