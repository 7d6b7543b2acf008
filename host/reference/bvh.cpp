#include "host/reference/bvh.hpp"

#include <cmath>

namespace stromboli::reference {
namespace {

/// Deepest tree of bvh_build.cpp, 48 + 32, and one more.
constexpr unsigned kStackSize = 81;

/// Distance at which the ray enters the box, infinity if it misses. Never misses a box that the
/// exact ray meets: the far distance is stretched by the error of both (Ize, "Robust BVH Ray
/// Traversal", JCGT 2013), and NaN (a ray within a plane of the box) fails every comparison.
double enter(const Ray& ray, const glm::dvec3& inverse, const glm::dvec3& lo,
             const glm::dvec3& hi) {
    constexpr double gamma3 = 3 * kRoundoff / (1 - 3 * kRoundoff);
    double near = ray.tMin, far = ray.tMax;
    for (int axis = 0; axis < 3; ++axis) {
        const bool backwards = inverse[axis] < 0;
        const double first = ((backwards ? hi : lo)[axis] - ray.origin[axis]) * inverse[axis];
        const double last =
            ((backwards ? lo : hi)[axis] - ray.origin[axis]) * inverse[axis] * (1 + 2 * gamma3);
        if (first > near) near = first;
        if (last < far) far = last;
    }
    return near <= far ? near : kInfinity;
}

} // namespace

std::optional<Hit> Bvh::intersect(const Ray& ray, uint32_t primitive) const {
    if (primitive < scene_.triangles.size()) {
        const Triangle& t = scene_.triangles[primitive];
        return intersectTriangle(ray, scene_.positions[t.corner[0]], scene_.positions[t.corner[1]],
                                 scene_.positions[t.corner[2]]);
    }
    const Sphere& s = scene_.spheres[primitive - scene_.triangles.size()];
    return intersectSphere(ray, s.center, s.radius);
}

/// Calls visit(primitive, ray) for the primitives of all leaves the ray meets, near ones first;
/// visit may shorten the ray, and ends the traversal by returning false.
template <class Visit>
void Bvh::traverse(const Ray& start, Visit&& visit) const {
    struct Entry {
        uint32_t node;
        double distance;
    };
    std::array<Entry, kStackSize> stack;
    unsigned size = 0;
    Ray ray = start;
    const glm::dvec3 inverse = 1.0 / ray.direction;
    const auto distanceTo = [&](uint32_t node) {
        return enter(ray, inverse, nodes_[node].box.lo, nodes_[node].box.hi);
    };
    stack[size++] = {0, distanceTo(0)};
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.distance > ray.tMax || entry.distance == kInfinity) continue;
        const Node& node = nodes_[entry.node];
        for (uint32_t i = 0; i < node.count; ++i)
            if (!visit(order_[node.first + i], ray)) return;
        if (node.count > 0) continue;
        Entry near{node.first, distanceTo(node.first)};
        Entry far{node.first + 1, distanceTo(node.first + 1)};
        if (far.distance < near.distance) std::swap(near, far);
        stack[size++] = far;
        stack[size++] = near;
    }
}

Hit Bvh::closest(const Ray& start, Skip skip) const {
    Hit best;
    if (order_.empty()) return best;
    traverse(start, [&](uint32_t primitive, Ray& ray) {
        if (skip(primitive)) return true;
        if (auto hit = intersect(ray, primitive)) {
            best = *hit;
            best.primitive = primitive;
            ray.tMax = hit->t;
        }
        return true;
    });
    return best;
}

Hit Bvh::closestBehind(const Ray& start, const Hit& passed, Skip skip) const {
    // Boxes and primitives find distances with different rounding errors, of few units each: a box
    // counts well beyond both ends, so that no primitive at an end is overlooked.
    constexpr double kMargin = 0x1p-40;
    const bool begun = passed.primitive != kNoPrimitive;
    Hit best;
    if (order_.empty()) return best;
    Ray boxes = start;
    if (begun) boxes.tMin = passed.t * (1 - kMargin);
    traverse(boxes, [&](uint32_t primitive, Ray& ray) {
        if (skip(primitive)) return true;
        Ray probe = start;
        if (begun)
            probe.tMin = primitive > passed.primitive ? std::nextafter(passed.t, 0.0) : passed.t;
        const bool found = best.primitive != kNoPrimitive;
        if (found)
            probe.tMax = primitive < best.primitive ? std::nextafter(best.t, kInfinity) : best.t;
        if (auto hit = intersect(probe, primitive)) {
            best = *hit;
            best.primitive = primitive;
            ray.tMax = hit->t * (1 + kMargin);
        }
        return true;
    });
    return best;
}

bool Bvh::occluded(const Ray& start, Skip skip) const {
    bool found = false;
    if (order_.empty()) return found;
    traverse(start, [&](uint32_t primitive, Ray& ray) {
        found = !skip(primitive) && intersect(ray, primitive).has_value();
        return !found;
    });
    return found;
}

} // namespace stromboli::reference
