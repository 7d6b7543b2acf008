#include "host/bench/bvh_bench.hpp"

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/leaf_items.hpp"
#include "host/bvh/statistics.hpp"
#include "host/bvh/wide_layout.hpp"

namespace stromboli::bench {

BvhReport benchBvh(const Arena& arena) {
    const Scene& scene = arena.scene.scene;
    std::vector<Contestant> contestants = {{"ours", [&] {
                                                buildWideBvh(scene);
                                                return Work{};
                                            }}};
    uint64_t embreeBytes = 0;
    if (arena.embree) {
        const auto build = [&, geometry = arena.embree->geometry(scene)](EmbreeQuality quality) {
            // In its robust mode Embree builds the same whatever the quality.
            embreeBytes = arena.embree->build(geometry, EmbreeMode::Fast, quality)->bytes;
            return Work{};
        };
        contestants.push_back(
            {"Embree, medium quality", [build] { return build(EmbreeQuality::Medium); }});
        contestants.push_back(
            {"Embree, high quality", [build] { return build(EmbreeQuality::High); }});
    }
    contestants.push_back({"ours, binary tree alone", [&] {
                               buildBinaryTree(bvh::itemBounds(scene, bvh::makeLeafItems(scene)));
                               return Work{};
                           }});
    BvhReport report;
    report.builds = alternate(contestants, arena.plan);
    report.binaryTree = std::move(report.builds.back());
    report.builds.pop_back();
    const BvhStatistics statistics = measure(buildWideBvh(scene));
    report.expectedVisits = statistics.expectedVisits;
    report.bytesPerPrimitive = statistics.bytesPerPrimitive();
    const size_t primitives = scene.triangles.size() + scene.spheres.size();
    if (primitives > 0) report.embreeBytesPerPrimitive = double(embreeBytes) / double(primitives);
    return report;
}

} // namespace stromboli::bench
