#include "host/bench/ray_bench.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::bench {
namespace {

/// Relative; some hundred roundings of distances seen at a slant. A hit on another surface is
/// farther off, but where two of them meet.
constexpr float kSameDistance = 0x1p-14f;

bool isHit(float distance) {
    return distance < std::numeric_limits<float>::max();
}

bool agree(float a, float b, bool anyHit) {
    if (isHit(a) != isHit(b)) return false;
    if (!isHit(a) || anyHit) return true;
    return std::abs(a - b) <= kSameDistance * std::max(a, b);
}

} // namespace

double hitShare(const std::vector<float>& distances) {
    return double(std::count_if(distances.begin(), distances.end(), isHit)) /
           double(std::max<size_t>(distances.size(), 1));
}

uint64_t countDisagreements(const RaySet& set, const std::vector<float>& a,
                            const std::vector<float>& b) {
    uint64_t count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += agree(a[i], b[i], set.anyHit) ? 0 : 1;
    return count;
}

RayReport benchRays(const Arena& arena, DeviceRays& device, const EmbreePair& embree,
                    const RaySet& set) {
    RayReport report;
    report.kind = set.name;
    report.rays = set.rays.size();
    if (set.rays.empty()) return report;
    device.load(set);
    const std::vector<float> distances = device.distances();
    report.hitShare = hitShare(distances);

    const auto rays = double(set.rays.size());
    std::vector<Contestant> contestants = {{"device", [&] {
                                                return Work{rays, device.trace().deviceSeconds};
                                            }}};
    const auto add = [&](const char* name, const EmbreeScene* scene) {
        if (!scene) return;
        report.disagreements.push_back(countDisagreements(set, distances, scene->distances(set)));
        contestants.push_back({name, [&set, scene, rays] {
                                   scene->trace(set);
                                   return Work{rays, 0};
                               }});
    };
    add("Embree fast", embree.fast.get());
    add("Embree robust", embree.robust.get());
    report.contestants = alternate(contestants, arena.plan);
    return report;
}

} // namespace stromboli::bench
