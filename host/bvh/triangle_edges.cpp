#include "host/bvh/triangle_edges.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

namespace stromboli::bvh {

namespace {

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

} // namespace

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

} // namespace stromboli::bvh
