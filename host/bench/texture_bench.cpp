#include "host/bench/texture_bench.hpp"

#include "host/bench/painter.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "scene/add_environment.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>

namespace stromboli::bench {
namespace {

constexpr const char* kSky = "evening_sky";

glm::dvec4 meanOf(const Scene& scene, const TextureUse& use) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    glm::dvec4 sum(0);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            sum += texelAt(image, texture.srgb, x, y);
    return sum / double(uint64_t(image.width) * image.height);
}

/// The share of light that meets the surface, in the mean over its texture.
float meanOpacity(const Scene& scene, const TextureUse& use, const Material& m) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    double sum = 0;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const double opacity = m.opacity * texelAt(image, texture.srgb, x, y).a;
            sum += m.alphaMode == AlphaMode::Mask ? double(opacity >= m.alphaCutoff) : opacity;
        }
    return float(sum / double(uint64_t(image.width) * image.height));
}

/// A mask with the mean of its texture would be there everywhere or nowhere, and the scene another
/// one; so as much of it blends as is there.
void takeMeanOpacity(const Scene& scene, const TextureUse& use, Material& m) {
    if (use.slot != TextureSlot::BaseColor || m.alphaMode == AlphaMode::Opaque) return;
    m.opacity = meanOpacity(scene, use, m);
    m.alphaMode = AlphaMode::Blend;
}

/// The textures that most materials have; the mean of others is taken for 1.
void multiplyByMean(const Scene& scene, const TextureUse& use, Material& m) {
    const glm::vec4 mean(meanOf(scene, use));
    if (use.slot == TextureSlot::BaseColor) {
        m.albedo *= glm::vec3(mean);
        m.principled.baseColor *= glm::vec3(mean);
    }
    if (use.slot == TextureSlot::MetallicRoughness) {
        m.principled.roughness *= mean.g;
        m.principled.metallic *= mean.b;
    }
}

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

Scene withMeans(Scene scene) {
    for (Material& m : scene.materials) {
        for (const TextureUse& use : m.textures) {
            multiplyByMean(scene, use, m);
            takeMeanOpacity(scene, use, m);
        }
        m.textures.clear();
    }
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
