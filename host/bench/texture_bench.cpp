#include "host/bench/texture_bench.hpp"

#include "host/bench/painter.hpp"
#include "host/bench/texture_means.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "scene/add_environment.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>

namespace stromboli::bench {
namespace {

constexpr const char* kSky = "evening_sky";

Scene underTheSky(Scene scene) {
    for (Material& m : scene.materials)
        if (textureIn(m, TextureSlot::Emission)) {
            m.emission = glm::vec3(0);
            std::erase_if(m.textures,
                          [](const TextureUse& use) { return use.slot == TextureSlot::Emission; });
        }
    addEnvironment(scene, {.file = kSky});
    return scene;
}

} // namespace

bool hasTextures(const Scene& scene) {
    return std::ranges::any_of(scene.materials,
                               [](const Material& m) { return !m.textures.empty(); });
}

TextureReport benchTextures(const Arena& arena) {
    const Scene textured = underTheSky(arena.scene.scene), constant = withMeans(textured);
    std::vector<GpuScene> packed;
    for (const Scene* scene : {&textured, &constant})
        packed.push_back(
            packScene(*scene, buildWideBvh(*scene), lightSelection(arena.settings.estimator)));
    std::vector<Painter> painters;
    for (size_t i = 0; i < packed.size(); ++i)
        painters.emplace_back(
            i == 0 ? "textures" : "their means",
            std::make_unique<VulkanBackend>(arena.device, packed[i], arena.camera, arena.settings),
            arena.settings, Painter::Item::Ray);
    TextureReport report;
    report.contestants = race(painters, arena.plan);
    for (const Painter& p : painters) {
        const RenderCounters counters = p.backend().counters();
        report.raysPerPath.push_back(double(counters.rays) /
                                     double(std::max<uint64_t>(counters.paths, 1)));
    }
    return report;
}

} // namespace stromboli::bench
