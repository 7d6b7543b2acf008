#include "scene/build/corner_tree.hpp"

#include <algorithm>

namespace stromboli::build {

CornerTree::CornerTree(std::span<const glm::dvec2> points, std::vector<uint32_t> corners)
    : points_(points), corners_(std::move(corners)), leafOf_(points.size(), kNone) {
    if (!corners_.empty()) build(0, uint32_t(corners_.size()), kNone);
}

/// Halves the points at the median of the longer side of their box: log2(n) levels.
uint32_t CornerTree::build(uint32_t first, uint32_t last, uint32_t parent) {
    const auto index = uint32_t(nodes_.size());
    glm::dvec2 lo = points_[corners_[first]], hi = lo;
    for (uint32_t i = first; i < last; ++i) {
        lo = glm::min(lo, points_[corners_[i]]);
        hi = glm::max(hi, points_[corners_[i]]);
    }
    nodes_.push_back({lo, hi, first, last, last - first, parent, kNone, kNone});
    if (last - first <= kLeafSize) {
        for (uint32_t i = first; i < last; ++i)
            leafOf_[corners_[i]] = index;
        return index;
    }
    const int axis = hi.x - lo.x >= hi.y - lo.y ? 0 : 1;
    const uint32_t middle = first + (last - first) / 2;
    std::nth_element(corners_.begin() + first, corners_.begin() + middle, corners_.begin() + last,
                     [&](uint32_t i, uint32_t j) { return points_[i][axis] < points_[j][axis]; });
    const uint32_t left = build(first, middle, index);
    const uint32_t right = build(middle, last, index);
    nodes_[index].left = left;
    nodes_[index].right = right;
    return index;
}

void CornerTree::remove(uint32_t corner) {
    for (uint32_t i = leafOf_[corner]; i != kNone; i = nodes_[i].parent)
        --nodes_[i].live;
    leafOf_[corner] = kNone;
}

/// False only if no point of the box is in the closed triangle: one of the triangle's sides, or of
/// the box's, separates them. Exact, so that no corner is missed.
bool CornerTree::mayMeet(const Node& node, const Corners& triangle) {
    const auto& [a, b, c] = triangle;
    const glm::dvec2 lo = glm::min(glm::min(a, b), c), hi = glm::max(glm::max(a, b), c);
    if (lo.x > node.hi.x || hi.x < node.lo.x || lo.y > node.hi.y || hi.y < node.lo.y) return false;
    const auto isOutside = [&](const glm::dvec2& from, const glm::dvec2& to) {
        // The box's corner that lies farthest to the left of the side.
        const glm::dvec2 farthest(to.y > from.y ? node.lo.x : node.hi.x,
                                  to.x > from.x ? node.hi.y : node.lo.y);
        return orientation(from, to, farthest) < 0;
    };
    return !isOutside(a, b) && !isOutside(b, c) && !isOutside(c, a);
}

} // namespace stromboli::build
