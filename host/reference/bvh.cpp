#include "host/reference/bvh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace stromboli::reference {

// --- Intersection --------------------------------------------------------------------------------

std::optional<Hit> intersectTriangle(const Ray& ray, const glm::dvec3& v0, const glm::dvec3& v1,
                                     const glm::dvec3& v2) {
    const glm::dvec3 e1 = v1 - v0, e2 = v2 - v0;
    const glm::dvec3 p = glm::cross(ray.direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0) return std::nullopt;

    const glm::dvec3 s = ray.origin - v0;
    const double b1 = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, e1);
    const double b2 = glm::dot(ray.direction, q) / determinant;
    // Written so that NaN, from triangles of almost no area, misses.
    if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)) return std::nullopt;

    const double t = glm::dot(e2, q) / determinant;
    if (!(t > ray.tMin && t < ray.tMax)) return std::nullopt;
    return Hit{t, kNoPrimitive, b1, b2};
}

std::optional<Hit> intersectSphere(const Ray& ray, const glm::dvec3& center, double radius) {
    const glm::dvec3 f = center - ray.origin;
    const double along = glm::dot(f, ray.direction);
    // From the distance between line and centre: b^2 - 4ac would cancel for far spheres
    // (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems).
    const glm::dvec3 across = f - along * ray.direction;
    const double discriminant = radius * radius - glm::dot(across, across);
    if (discriminant < 0) return std::nullopt;

    const double root = std::sqrt(discriminant);
    const double q = along >= 0 ? along + root : along - root;
    if (q == 0) return std::nullopt; // touches the sphere at the origin of the ray
    double near = (glm::dot(f, f) - radius * radius) / q, far = q;
    if (near > far) std::swap(near, far);
    for (const double t : {near, far})
        if (t > ray.tMin && t < ray.tMax) return Hit{t, kNoPrimitive, 0, 0};
    return std::nullopt;
}

// --- Traversal -----------------------------------------------------------------------------------

namespace {

/// Deepest tree of bvh.cpp, 48 + 32, and one more.
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

// --- Building ------------------------------------------------------------------------------------

namespace {

constexpr uint32_t kLeafSize = 4;
constexpr int kBins = 16;
/// From this depth on ranges are halved, so that no tree is deeper than this plus 32 and the
/// stack of traverse() suffices.
constexpr unsigned kHalvingDepth = 48;

} // namespace

void Bvh::Box::extend(const Box& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
}

double Bvh::Box::halfArea() const {
    const glm::dvec3 e = glm::max(hi - lo, glm::dvec3(0.0));
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

Bvh::Bvh(const Scene& scene) : scene_(scene) {
    const auto count = uint32_t(scene.triangles.size() + scene.spheres.size());
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    boxes_.reserve(count);
    for (uint32_t i = 0; i < count; ++i)
        boxes_.push_back(boxOf(i));
    nodes_.emplace_back();
    build(0, {0, count}, 0);
    boxes_ = {};
}

Bvh::Box Bvh::boxOf(uint32_t primitive) const {
    Box box;
    if (primitive < scene_.triangles.size()) {
        for (uint32_t corner : scene_.triangles[primitive].corner) {
            const glm::dvec3 p = scene_.positions[corner];
            box.extend({p, p});
        }
    } else {
        const Sphere& s = scene_.spheres[primitive - scene_.triangles.size()];
        const glm::dvec3 center = s.center;
        box = {center - double(s.radius), center + double(s.radius)};
    }
    return box;
}

void Bvh::build(uint32_t node, Range range, unsigned depth) {
    Box box;
    for (uint32_t i = range.begin; i < range.end; ++i)
        box.extend(boxes_[order_[i]]);
    nodes_[node].box = box;
    if (range.end - range.begin <= kLeafSize) {
        nodes_[node].first = range.begin;
        nodes_[node].count = range.end - range.begin;
        return;
    }
    const uint32_t middle = split(range, box, depth);
    const auto children = uint32_t(nodes_.size());
    nodes_[node].first = children;
    nodes_.resize(nodes_.size() + 2);
    build(children, {range.begin, middle}, depth + 1);
    build(children + 1, {middle, range.end}, depth + 1);
}

uint32_t Bvh::split(Range range, const Box& box, unsigned depth) {
    const auto centroid = [&](uint32_t i) { return 0.5 * (boxes_[i].lo + boxes_[i].hi); };
    Box centroids;
    for (uint32_t i = range.begin; i < range.end; ++i)
        centroids.extend({centroid(order_[i]), centroid(order_[i])});
    const glm::dvec3 extent = centroids.hi - centroids.lo;
    const int longest = extent.x >= extent.y && extent.x >= extent.z ? 0
                        : extent.y >= extent.z                       ? 1
                                                                     : 2;
    if (depth >= kHalvingDepth || !(extent[longest] > 0)) return splitAtMedian(range, longest);

    const auto binOf = [&](uint32_t i, int axis) {
        const double at = (centroid(i)[axis] - centroids.lo[axis]) / extent[axis];
        return std::clamp(int(at * kBins), 0, kBins - 1);
    };
    double bestCost = kInfinity;
    int bestAxis = -1, bestBin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(extent[axis] > 0)) continue;
        std::array<Box, kBins> bins;
        std::array<uint32_t, kBins> counts{};
        for (uint32_t i = range.begin; i < range.end; ++i) {
            const int bin = binOf(order_[i], axis);
            bins[bin].extend(boxes_[order_[i]]);
            ++counts[bin];
        }
        std::array<double, kBins> rightCost{};
        Box right;
        uint32_t rightCount = 0;
        for (int bin = kBins - 1; bin > 0; --bin) {
            right.extend(bins[bin]);
            rightCount += counts[bin];
            rightCost[bin] = rightCount == 0 ? kInfinity : right.halfArea() * rightCount;
        }
        Box left;
        uint32_t leftCount = 0;
        for (int bin = 0; bin + 1 < kBins; ++bin) {
            left.extend(bins[bin]);
            leftCount += counts[bin];
            if (leftCount == 0) continue;
            const double cost = left.halfArea() * leftCount + rightCost[bin + 1];
            if (cost < bestCost) bestCost = cost, bestAxis = axis, bestBin = bin;
        }
    }
    // No better than one leaf: the parts overlap wholly, any halves do.
    if (bestAxis < 0 || !(bestCost < box.halfArea() * (range.end - range.begin)))
        return splitAtMedian(range, longest);
    const auto middle = std::partition(order_.begin() + range.begin, order_.begin() + range.end,
                                       [&](uint32_t i) { return binOf(i, bestAxis) <= bestBin; });
    return uint32_t(middle - order_.begin());
}

uint32_t Bvh::splitAtMedian(Range range, int axis) {
    const uint32_t middle = range.begin + (range.end - range.begin) / 2;
    std::nth_element(order_.begin() + range.begin, order_.begin() + middle,
                     order_.begin() + range.end, [&](uint32_t i, uint32_t j) {
                         return boxes_[i].lo[axis] + boxes_[i].hi[axis] <
                                boxes_[j].lo[axis] + boxes_[j].hi[axis];
                     });
    return middle;
}

} // namespace stromboli::reference
