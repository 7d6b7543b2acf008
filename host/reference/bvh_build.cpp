#include "host/reference/bvh.hpp"

#include <algorithm>
#include <numeric>

namespace stromboli::reference {
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
