#pragma once

#include "scene/build/orientation.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::build {

/// Points in a tree of boxes, to find those that lie in a triangle.
class CornerTree {
  public:
    CornerTree() = default;
    /// Holds the points of these numbers, each given once. `points`, all finite, must outlive the
    /// tree.
    CornerTree(std::span<const glm::dvec2> points, std::vector<uint32_t> corners);

    /// Takes a point out; nothing happens if it is not in the tree.
    void remove(uint32_t corner);

    /// True if found(corner) is, for one of a set of corners that includes all inside the
    /// counter-clockwise triangle a b c or on its border.
    template <typename Found>
    bool any(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, Found found) const {
        return !nodes_.empty() && anyBelow(0, {a, b, c}, found);
    }

  private:
    static constexpr uint32_t kNone = 0xFFFFFFFFu;
    static constexpr uint32_t kLeafSize = 8;

    struct Node {
        glm::dvec2 lo, hi;
        uint32_t first, last;         ///< range of corners_ below
        uint32_t live;                ///< how many of them are still in
        uint32_t parent, left, right; ///< kNone where there is none; leaves have no children
    };
    struct Corners {
        const glm::dvec2 &a, &b, &c;
    };

    uint32_t build(uint32_t first, uint32_t last, uint32_t parent);
    static bool mayMeet(const Node& node, const Corners& triangle);

    template <typename Found>
    bool anyBelow(uint32_t index, const Corners& triangle, Found& found) const {
        const Node& node = nodes_[index];
        if (node.live == 0 || !mayMeet(node, triangle)) return false;
        if (node.left != kNone)
            return anyBelow(node.left, triangle, found) || anyBelow(node.right, triangle, found);
        for (uint32_t i = node.first; i < node.last; ++i)
            if (found(corners_[i])) return true;
        return false;
    }

    std::span<const glm::dvec2> points_;
    std::vector<uint32_t> corners_;
    std::vector<uint32_t> leafOf_; ///< by number of the point; kNone for those not in the tree
    std::vector<Node> nodes_;
};

} // namespace stromboli::build
