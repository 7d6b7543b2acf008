#include "host/bvh/scene_part.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace stromboli::bvh {

ScenePart partOf(const Scene& scene, uint32_t first, uint32_t end) {
    std::vector<uint32_t> triangles(end - first);
    std::iota(triangles.begin(), triangles.end(), first);
    return partOf(scene, std::move(triangles));
}

ScenePart partOf(const Scene& scene, std::vector<uint32_t> triangles) {
    ScenePart part;
    // A mesh uses a run of positions; numbers within it need no table over all of the scene's.
    uint32_t least = std::numeric_limits<uint32_t>::max(), most = 0;
    for (const uint32_t t : triangles)
        for (const uint32_t corner : scene.triangles[t].corner)
            least = std::min(least, corner), most = std::max(most, corner);
    constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> number(triangles.empty() ? 0 : most - least + 1, kUnused);
    for (const uint32_t t : triangles) {
        part.scene.triangles.push_back(scene.triangles[t]);
        for (uint32_t& corner : part.scene.triangles.back().corner) {
            uint32_t& found = number[corner - least];
            if (found == kUnused) {
                found = uint32_t(part.scene.positions.size());
                part.scene.positions.push_back(scene.positions[corner]);
            }
            corner = found;
        }
    }
    part.primitiveOf = std::move(triangles);
    return part;
}

bool haveSameShape(const Scene& a, const Scene& b) {
    const auto bytes = [](const Scene& s) { return std::as_bytes(std::span(s.positions)); };
    return std::ranges::equal(bytes(a), bytes(b)) &&
           std::ranges::equal(a.triangles, b.triangles, [](const Triangle& s, const Triangle& t) {
               return std::ranges::equal(s.corner, t.corner);
           });
}

} // namespace stromboli::bvh
