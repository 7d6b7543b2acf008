#include "host/bvh/triangle_pairs.hpp"

#include "host/bvh/primitive_bounds.hpp"
#include "host/bvh/triangle_edges.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace stromboli::bvh {

namespace {

/// Area saved by pairing the triangles on both sides of an edge.
float savedArea(const Scene& scene, uint32_t edge, uint32_t opposite) {
    const Bounds a = primitiveBounds(scene, edge / 3), b = primitiveBounds(scene, opposite / 3);
    Bounds both = a;
    both.extend(b);
    return a.halfArea() + b.halfArea() - both.halfArea();
}

/// Greedy matching: the pair of the greatest gain first, of equal ones that of the least edge. It
/// is found without sorting, in linear time, as any two triangles that like each other best of
/// all that are left are in it (Preis 1999): walk from a triangle to the one it likes best until
/// two like each other.
class Matching {
  public:
    explicit Matching(const Scene& scene)
        : opposite_(oppositeEdges(scene)), gain_(opposite_.size()),
          paired_(scene.triangles.size(), 0) {
        const tbb::blocked_range<uint32_t> all(0, uint32_t(opposite_.size()), 1u << 12);
        tbb::parallel_for(all, [&](const auto& range) {
            for (uint32_t edge = range.begin(); edge != range.end(); ++edge)
                // The lower edge's, so that both sides have the same bits.
                if (opposite_[edge] != kNoEdge)
                    gain_[edge] = savedArea(scene, std::min(edge, opposite_[edge]),
                                            std::max(edge, opposite_[edge]));
        });
    }

    std::vector<TrianglePair> run() {
        std::vector<TrianglePair> pairs;
        for (uint32_t triangle = 0; triangle < paired_.size(); ++triangle)
            if (!paired_[triangle]) pairFrom(triangle);
        for (uint32_t triangle = 0; triangle < paired_.size(); ++triangle) {
            if (!paired_[triangle]) continue;
            const uint32_t edge = 3 * triangle + paired_[triangle] - 1, other = opposite_[edge];
            if (edge < other)
                pairs.push_back({{triangle, other / 3}, {uint8_t(edge % 3), uint8_t(other % 3)}});
        }
        return pairs;
    }

  private:
    /// Pairs the triangle, unless all its neighbours are taken; and others on the way.
    void pairFrom(uint32_t triangle) {
        way_.assign(1, triangle);
        while (!way_.empty()) {
            const uint32_t edge = bestEdge(way_.back());
            const uint32_t other = edge == kNoEdge ? kNoEdge : opposite_[edge];
            if (edge != kNoEdge && bestEdge(other / 3) != other) {
                way_.push_back(other / 3); // which likes another one better
                continue;
            }
            if (edge != kNoEdge) {
                paired_[edge / 3] = uint8_t(1 + edge % 3);
                paired_[other / 3] = uint8_t(1 + other % 3);
            }
            way_.pop_back();
            while (!way_.empty() && paired_[way_.back()])
                way_.pop_back();
        }
    }

    /// The edge across which the triangle's best neighbour lies; kNoEdge if none is left.
    uint32_t bestEdge(uint32_t triangle) const {
        uint32_t best = kNoEdge;
        for (uint32_t edge = 3 * triangle; edge < 3 * triangle + 3; ++edge) {
            const uint32_t other = opposite_[edge];
            if (other == kNoEdge || paired_[other / 3] || !(gain_[edge] >= 0)) continue;
            if (best == kNoEdge || preferred(edge, best)) best = edge;
        }
        return best;
    }

    bool preferred(uint32_t edge, uint32_t to) const {
        if (gain_[edge] != gain_[to]) return gain_[edge] > gain_[to];
        return std::min(edge, opposite_[edge]) < std::min(to, opposite_[to]);
    }

    std::vector<uint32_t> opposite_;
    std::vector<float> gain_;     ///< by edge
    std::vector<uint8_t> paired_; ///< by triangle: 1 + the corner where its edge begins, or 0
    std::vector<uint32_t> way_;   ///< each likes the next best
};

} // namespace

std::vector<TrianglePair> pairTriangles(const Scene& scene) {
    return Matching(scene).run();
}

} // namespace stromboli::bvh
