#include "host/bvh/leaf_items.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace stromboli {

// --- Bounds of primitives ------------------------------------------------------------------------

namespace {

/// fl(a + b) - (a + b) has the sign of minus this: the part of the exact sum that rounding lost,
/// exactly (Knuth's TwoSum).
float lostInSum(float a, float b, float sum) {
    const float bRounded = sum - a;
    return (a - (sum - bRounded)) + (b - bRounded);
}

/// centre +- radius is rounded to the nearest float, which may lie inside the sphere by up to half
/// an ulp. A ray tangent to the sphere there would miss the box and hit the sphere, so a bound
/// that was rounded inward goes on to the next float, which lies beyond the exact value.
float sumRoundedDown(float a, float b) {
    const float sum = a + b;
    return lostInSum(a, b, sum) < 0 ? std::nextafter(sum, -std::numeric_limits<float>::infinity())
                                    : sum;
}

float sumRoundedUp(float a, float b) {
    return -sumRoundedDown(-a, -b);
}

Bounds sphereBounds(const Sphere& s) {
    Bounds b;
    for (int axis = 0; axis < 3; ++axis) {
        b.lo[axis] = sumRoundedDown(s.center[axis], -s.radius);
        b.hi[axis] = sumRoundedUp(s.center[axis], s.radius);
    }
    return b;
}

} // namespace

Bounds primitiveBounds(const Scene& scene, uint32_t primitive) {
    if (primitive >= scene.triangles.size())
        return sphereBounds(scene.spheres[primitive - scene.triangles.size()]);
    Bounds b;
    glm::vec3 poison(0.0f); // min and max pass over NaN; 0 times it, or infinity, is NaN
    for (const uint32_t corner : scene.triangles[primitive].corner) {
        b.extend(scene.positions[corner]);
        poison += 0.0f * scene.positions[corner];
    }
    b.lo += poison;
    return b;
}

} // namespace stromboli

namespace stromboli::bvh {

// --- Edges that triangles share ------------------------------------------------------------------

namespace {

constexpr uint32_t kNoEdge = 0xFFFFFFFFu;

using PositionBits = std::array<uint32_t, 3>;

PositionBits bitsOf(const glm::vec3& p) {
    return {std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y),
            std::bit_cast<uint32_t>(p.z)};
}

/// Mixes all bits into the upper ones (multiplication by odd constants, after Fibonacci hashing).
uint64_t hashOf(const PositionBits& p) {
    constexpr uint64_t kGolden = 0x9E3779B97F4A7C15u;
    uint64_t h = (uint64_t(p[0]) << 32 | p[1]) * kGolden;
    h = (h ^ h >> 29 ^ p[2]) * kGolden;
    return (h ^ h >> 32) * kGolden;
}

/// By position: the first position with the same bits. An open hash table of twice the size.
std::vector<uint32_t> firstWithSameBits(const std::vector<glm::vec3>& positions) {
    if (positions.empty()) return {};
    constexpr uint32_t kFree = 0xFFFFFFFFu;
    const int bits = int(std::bit_width(2 * positions.size()));
    const uint64_t mask = (uint64_t(1) << bits) - 1;
    std::vector<uint32_t> table(mask + 1, kFree);
    std::vector<uint32_t> first(positions.size());
    for (uint32_t i = 0; i < positions.size(); ++i) {
        const PositionBits p = bitsOf(positions[i]);
        uint64_t slot = hashOf(p) >> (64 - bits);
        while (table[slot] != kFree && bitsOf(positions[table[slot]]) != p)
            slot = (slot + 1) & mask;
        if (table[slot] == kFree) table[slot] = i;
        first[i] = table[slot];
    }
    return first;
}

/// An edge of a triangle at the lower of its two positions' numbers.
struct EdgeAt {
    uint32_t high; ///< the other one
    uint32_t edge;
    bool ascending; ///< goes from the lower to the higher

    bool operator<(const EdgeAt& o) const {
        return std::tie(high, edge) < std::tie(o.high, o.edge);
    }
};

/// The edges of all triangles sorted into buckets by the lower position (counting sort).
struct EdgeBuckets {
    std::vector<uint32_t> start; ///< by position; one more at the end
    std::vector<EdgeAt> edges;
};

EdgeBuckets sortEdges(const Scene& scene) {
    const std::vector<uint32_t> position = firstWithSameBits(scene.positions);
    const auto forEachEdge = [&](auto use) {
        for (uint32_t t = 0; t < scene.triangles.size(); ++t)
            for (uint32_t c = 0; c < 3; ++c) {
                const uint32_t from = position[scene.triangles[t].corner[c]];
                const uint32_t to = position[scene.triangles[t].corner[c == 2 ? 0 : c + 1]];
                if (from != to)
                    use(std::min(from, to), EdgeAt{std::max(from, to), 3 * t + c, from < to});
            }
    };
    EdgeBuckets buckets;
    buckets.start.resize(position.size() + 1);
    forEachEdge([&](uint32_t low, const EdgeAt&) { ++buckets.start[low]; });
    uint32_t end = 0;
    for (uint32_t& start : buckets.start)
        start = end += start;
    buckets.edges.resize(end);
    forEachEdge(
        [&](uint32_t low, const EdgeAt& edge) { buckets.edges[--buckets.start[low]] = edge; });
    return buckets;
}

/// For each edge of each triangle the edge of another triangle that joins the same two positions
/// (bit for bit) in the opposite direction, or kNoEdge. Edge 3 * t + c of triangle t goes from its
/// corner c to the next. Where more than two triangles meet in an edge, some are joined in pairs.
std::vector<uint32_t> oppositeEdges(const Scene& scene) {
    EdgeBuckets buckets = sortEdges(scene);
    std::vector<uint32_t> opposite(3 * scene.triangles.size(), kNoEdge);
    const auto joinInBucket = [&](size_t bucket) {
        const auto begin = buckets.edges.begin() + buckets.start[bucket];
        const auto end = buckets.edges.begin() + buckets.start[bucket + 1];
        std::sort(begin, end);
        for (auto a = begin; a + 1 < end; ++a) {
            const auto b = a + 1;
            if (a->high != b->high || a->ascending == b->ascending) continue;
            if (a->edge / 3 == b->edge / 3) continue; // a triangle there and back
            opposite[a->edge] = b->edge;
            opposite[b->edge] = a->edge;
            ++a; // both are taken
        }
    };
    const size_t count = buckets.start.size() - 1;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1u << 12), [&](const auto& range) {
        for (size_t bucket = range.begin(); bucket != range.end(); ++bucket)
            joinInBucket(bucket);
    });
    return opposite;
}

// --- Pairs of triangles --------------------------------------------------------------------------

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

// --- Items of leaves -----------------------------------------------------------------------------

std::vector<LeafItem> makeLeafItems(const Scene& scene) {
    std::vector<LeafItem> items;
    std::vector<bool> paired(scene.triangles.size(), false);
    for (const TrianglePair& pair : pairTriangles(scene)) {
        // The shared edge goes from edge[0] to the next corner in the first triangle, and is the
        // side from p2 to p0 there: p0 is the corner after edge[0]. In the second it goes from p0
        // to p2, which are that triangle's first two.
        items.push_back({pair.triangle, {uint8_t((pair.edge[0] + 1) % 3), pair.edge[1]}});
        for (const uint32_t triangle : pair.triangle)
            paired[triangle] = true;
    }
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        if (!paired[i]) items.push_back({{i, gpu::NO_PRIMITIVE}, {0, 0}});
    for (uint32_t i = 0; i < scene.spheres.size(); ++i)
        items.push_back({{uint32_t(scene.triangles.size()) + i, gpu::NO_PRIMITIVE}, {0, 0}});
    return items;
}

std::vector<Bounds> itemBounds(const Scene& scene, std::span<const LeafItem> items) {
    std::vector<Bounds> bounds(items.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, items.size(), 1u << 12), [&](const auto& r) {
        for (size_t i = r.begin(); i != r.end(); ++i) {
            bounds[i] = primitiveBounds(scene, items[i].primitive[0]);
            if (items[i].count() == 2)
                bounds[i].extend(primitiveBounds(scene, items[i].primitive[1]));
        }
    });
    return bounds;
}

} // namespace stromboli::bvh
