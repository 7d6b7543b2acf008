#include "host/bench/embree_paths.hpp"

#include "host/bench/embree.hpp"
#include "host/bench/workers.hpp"

#include <algorithm>
#include <atomic>

namespace stromboli::bench {
namespace {

constexpr uint64_t kBlock = 64; ///< pixels a thread takes at a time

/// The samples' statistics in the film's terms.
PixelStatistics statisticsOf(const native::PixelSums& sums) {
    PixelStatistics p;
    p.count = sums.count;
    p.rejected = sums.rejected;
    if (sums.rejected > 0) p.firstRejected = sums.firstRejected;
    if (sums.count == 0) return p;
    for (int c = 0; c < 3; ++c) {
        p.mean[c] = sums.sum[c] / sums.count;
        p.m2[c] = std::max(sums.squares[c] - sums.sum[c] * p.mean[c], 0.0);
    }
    return p;
}

} // namespace

void EmbreePaths::sample(std::span<const PixelTarget> targets, Film& film,
                         const PassProgress& progress) {
    std::atomic<uint64_t> paths{0}, rays{0};
    forBlocks(threads_, targets.size(), kBlock, native::prepareThread,
              [&](uint64_t first, uint64_t count) {
                  uint64_t blockPaths = 0, blockRays = 0;
                  for (const PixelTarget& target : targets.subspan(first, count)) {
                      PixelStatistics& pixel = film.pixels[target.pixel];
                      if (pixel.taken() >= target.samples) continue;
                      const uint32_t wanted = target.samples - pixel.taken();
                      const native::PixelSums sums = native::samplePixel(
                          world_.world(), world_.features(), target.pixel, pixel.taken(), wanted);
                      pixel.merge(statisticsOf(sums));
                      blockPaths += wanted;
                      blockRays += sums.rays;
                  }
                  paths += blockPaths;
                  rays += blockRays;
              });
    counters_.paths += paths;
    counters_.rays += rays;
    if (progress) progress(paths);
}

SampleValue EmbreePaths::sampleAlone(uint32_t pixel, uint32_t sample) {
    const native::PixelSums sums =
        native::samplePixel(world_.world(), world_.features(), pixel, sample, 1);
    counters_.paths += 1;
    counters_.rays += sums.rays;
    return {{sums.sum[0], sums.sum[1], sums.sum[2]}, sums.rejected > 0};
}

std::string embreePathsLack(const Scene& scene, const RenderSettings& settings) {
    if (settings.estimator.conventions != ShadingConventions{})
        return "other shading conventions than the default";
    if (settings.estimator.integrator != Integrator::Path) return "normals and depth integrators";
    if (settings.estimator.roulette.throughputStart != Roulette::kThroughputStart)
        return "roulette that begins elsewhere";
    if (!samplesLights(settings.estimator.directLight) ||
        settings.estimator.directLight == DirectLight::MisAll)
        return "direct light other than by lights";
    if (settings.estimator.filter != PixelFilter::Box) return "pixel filters";
    if (scene.environment) return "environments";
    if (!scene.placements.empty()) return "instances";
    if (!scene.attributes.empty()) return "textures and colours of corners";
    const auto anyHas = [&](const auto& isSo) {
        const auto hasIt = [&](const auto& primitive) {
            return isSo(scene.materials[primitive.material]);
        };
        return std::ranges::any_of(scene.triangles, hasIt) ||
               std::ranges::any_of(scene.spheres, hasIt);
    };
    if (anyHas([](const Material& m) { return m.kind == MaterialKind::Principled; }))
        return "principled materials";
    if (anyHas([](const Material& m) {
            return m.kind >= MaterialKind::Conductor &&
                   !(m.kind == MaterialKind::Dielectric && m.isSmooth());
        }))
        return "conductors, rough and thin dielectrics, and plastic";
    if (anyHas([](const Material& m) {
            return m.alphaMode != AlphaMode::Opaque || m.isHiddenFromCamera;
        }))
        return "surfaces that are partly not there";
    if (anyHas([](const Material& m) { return m.other != kNoMaterial || m.isBlackBehind; }))
        return "mixtures of materials, and surfaces that are black behind";
    if (std::ranges::any_of(scene.lights,
                            [](const Light& l) { return l.kind == LightKind::Projector; }))
        return "projectors";
    return {};
}

} // namespace stromboli::bench
