#include "host/bench/contestants.hpp"

#include "host/engine/load_scene.hpp"
#include "scene/find_scene.hpp"

namespace stromboli::bench {

BenchScene loadBenchScene(const std::string& name) {
    return {name, sceneFile(name), std::move(*loadScene({name, {}, {}}).scene)};
}

const char* nameOf(EmbreeQuality quality) {
    return quality == EmbreeQuality::High ? "high" : "medium";
}

Camera cameraOf(const BenchScene& scene, const RenderSettings& settings) {
    return makeCamera(scene.scene, CameraChoice::Automatic, settings.area.width,
                      settings.area.height);
}

EmbreePair buildBest(const Arena& arena, const RaySet& rays) {
    if (!arena.embree) return {};
    const auto geometry = arena.embree->geometry(arena.scene.scene);
    const auto build = [&](EmbreeMode mode, EmbreeQuality quality) {
        return arena.embree->build(geometry, mode, quality);
    };
    auto medium = build(EmbreeMode::Fast, EmbreeQuality::Medium);
    auto high = build(EmbreeMode::Fast, EmbreeQuality::High);
    const auto tracing = [&](const EmbreeScene& built) {
        return [&] {
            built.trace(rays);
            return Work{double(rays.rays.size()), 0};
        };
    };
    AlternatePlan plan = arena.plan;
    plan.repeats = 3;
    const std::vector<Series> trials = alternate(
        {{"Embree's medium quality", tracing(*medium)}, {"Embree's high quality", tracing(*high)}},
        plan);
    const bool highWins =
        spreadOf(trials[1].cpuSeconds).median < spreadOf(trials[0].cpuSeconds).median;
    EmbreePair pair;
    pair.quality = highWins ? EmbreeQuality::High : EmbreeQuality::Medium;
    pair.fast = std::move(highWins ? high : medium);
    medium.reset();
    high.reset();
    pair.robust = build(EmbreeMode::Robust, pair.quality);
    return pair;
}

} // namespace stromboli::bench
