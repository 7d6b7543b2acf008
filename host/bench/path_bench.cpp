#include "host/bench/path_bench.hpp"

#include "host/engine/load_scene.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "scene/add_environment.hpp"
#include "scene/model/surface_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::bench {

Painter::Painter(std::string name, std::unique_ptr<Backend> backend, const RenderSettings& settings,
                 Item item)
    : name_(std::move(name)), backend_(std::move(backend)), settings_(settings), item_(item),
      film_(settings.area) {}

Work Painter::goOn() {
    samples_ += settings_.budget.mostSamplesPerPixel;
    std::vector<PixelTarget> targets;
    for (uint32_t pixel = 0; pixel < film_.pixels.size(); ++pixel)
        targets.push_back({pixel, samples_});
    const double secondsBefore = deviceSeconds();
    const uint64_t raysBefore = backend_->counters().rays;
    backend_->sample(targets, film_, {});
    const double items = item_ == Item::Ray
                             ? double(backend_->counters().rays - raysBefore)
                             : double(film_.pixels.size()) * settings_.budget.mostSamplesPerPixel;
    return {items, deviceSeconds() - secondsBefore};
}

double Painter::deviceSeconds() const {
    const auto* vulkan = dynamic_cast<const VulkanBackend*>(backend_.get());
    return vulkan ? vulkan->kernelSeconds() : 0;
}

std::vector<Series> race(std::vector<Painter>& painters, AlternatePlan plan) {
    plan.leastSeconds = 0;
    std::vector<Contestant> contestants;
    for (Painter& p : painters)
        contestants.push_back({p.name(), [&p] { return p.goOn(); }});
    return alternate(contestants, plan);
}

namespace {

glm::dvec4 meanOf(const Scene& scene, const TextureUse& use) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    glm::dvec4 sum(0);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            sum += texelAt(image, texture.srgb, x, y);
    return sum / double(uint64_t(image.width) * image.height);
}

void multiplyByMean(const Scene& scene, const TextureUse& use, Material& m) {
    if (use.slot == TextureSlot::BaseColor) {
        const glm::vec3 mean(meanOf(scene, use));
        m.albedo *= mean;
        m.principled.baseColor *= mean;
    }
    if (use.slot == TextureSlot::MetallicRoughness) {
        const glm::vec4 mean(meanOf(scene, use));
        m.principled.roughness *= mean.g;
        m.principled.metallic *= mean.b;
    }
}

bool opacityHasTexture(const Material& m) {
    return m.alphaMode != AlphaMode::Opaque &&
           (textureIn(m, TextureSlot::BaseColor) || textureIn(m, TextureSlot::Opacity));
}

/// Over texture coordinates from 0 to 1, as a render looks textures up: a mask's edge runs between
/// texels.
float meanOpacity(const Scene& scene, const Material& m) {
    constexpr uint32_t kPlaces = 256; // a side
    double sum = 0;
    for (uint32_t y = 0; y < kPlaces; ++y)
        for (uint32_t x = 0; x < kPlaces; ++x) {
            const glm::dvec2 uv((x + 0.5) / kPlaces, (y + 0.5) / kPlaces);
            sum += opacityAt(scene, m, {.uv = {uv, uv}});
        }
    return float(sum / (kPlaces * kPlaces));
}

} // namespace

Scene withMeans(Scene scene) {
    for (Material& m : scene.materials) {
        if (opacityHasTexture(m)) {
            m.opacity = meanOpacity(scene, m);
            m.alphaMode = AlphaMode::Blend;
        }
        for (const TextureUse& use : m.textures)
            multiplyByMean(scene, use, m);
        m.textures.clear();
    }
    return scene;
}

namespace {

/// Counting slows the kernel down, so it is done on the side, in another one.
double lanesBusy(const Arena& arena, const GpuScene& gpu) {
    KernelTuning tuning;
    tuning.countSteps = true;
    auto backend =
        std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera, arena.settings, tuning);
    const VulkanBackend& counting = *backend;
    Painter painter("counting steps", std::move(backend), arena.settings);
    painter.goOn();
    const StepCounters steps = counting.steps();
    return steps.all > 0 ? double(steps.busy) / double(steps.all) : 0;
}

} // namespace

PathReport benchPaths(const Arena& arena, const GpuScene& gpu) {
    PathReport report;
    std::vector<Painter> painters;
    painters.emplace_back(
        "device", std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera, arena.settings),
        arena.settings);
    report.contestants = race(painters, arena.plan);
    const RenderCounters counters = painters[0].backend().counters();
    report.raysPerPath = double(counters.rays) / double(std::max<uint64_t>(counters.paths, 1));
    if (arena.device.description().isCpu())
        report.driverBusy = report.contestants[0].parallelism() / arena.threads;
    report.lanesBusy = lanesBusy(arena, gpu);
    return report;
}

std::vector<KernelVariant> kernelVariants(const GpuScene& scene) {
    KernelTuning everything;
    everything.everythingOn = true;
    std::vector<KernelVariant> variants = {{"everything on", everything}};
    if (scene.hasPlacements)
        for (const uint32_t steps : {1u, 2u, 4u}) {
            KernelTuning legs;
            legs.traversalSteps = steps;
            legs.traversalLegs = 20 / steps;
            variants.push_back({fmt::format("legs of {}", steps), legs});
        }
    return variants;
}

VariantReport benchVariants(const Arena& arena, const GpuScene& gpu,
                            const std::vector<KernelVariant>& variants,
                            const std::string& ourName) {
    std::vector<Painter> painters;
    const auto add = [&](const std::string& name, const KernelTuning& tuning) {
        painters.emplace_back(name,
                              std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera,
                                                              arena.settings, tuning),
                              arena.settings);
    };
    add(ourName, {});
    for (const KernelVariant& v : variants)
        add(v.name, v.tuning);
    VariantReport report;
    report.contestants = race(painters, arena.plan);
    for (size_t i = 1; i < painters.size(); ++i)
        report.samePicture.push_back(std::equal(
            painters[0].film().pixels.begin(), painters[0].film().pixels.end(),
            painters[i].film().pixels.begin(),
            [](const PixelStatistics& a, const PixelStatistics& b) { return a.mean == b.mean; }));
    return report;
}

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
    for (const Scene* scene : {&textured, &constant}) {
        packed.push_back(buildScene(*scene, arena.settings.estimator).gpu);
        fitToPicture(packed.back(), *scene, arena.camera, arena.settings.estimator);
    }
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
