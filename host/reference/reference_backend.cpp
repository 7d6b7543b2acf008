#include "host/reference/reference_backend.hpp"

#include "host/reference/camera.hpp"
#include "host/reference/integrator.hpp"
#include "host/reference/sampling.hpp"
#include "scene/model/placements.hpp"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

namespace stromboli {
namespace {

/// Counts the samples of a pass and passes the count on about ten times a second.
class PassReport {
  public:
    explicit PassReport(const PassProgress& progress) : progress_(progress) {}

    bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
    void add(uint64_t samples) {
        const uint64_t done = done_.fetch_add(samples) + samples;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock.owns_lock()) return; // another thread is reporting
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return;
        tell(done);
        next_ = now + std::chrono::milliseconds(100);
    }
    void finish() { tell(done_.load()); }

  private:
    void tell(uint64_t done) {
        if (progress_ && !stopped() && !progress_(done)) stopped_ = true;
    }

    const PassProgress& progress_;
    std::atomic<uint64_t> done_{0};
    std::atomic<bool> stopped_{false};
    std::mutex mutex_;
    std::chrono::steady_clock::time_point next_{};
};

} // namespace

struct ReferenceBackend::Implementation {
    /// The scene with copies in place of placements, which makes traversal without them the judge
    /// of traversal with them. Empty where nothing is placed.
    std::optional<ExpandedScene> expanded;
    reference::World world;
    Camera camera;
    RenderSettings settings;
    reference::FilterSampler filter;
    const Scene& original;
    tbb::task_arena arena;
    uint32_t firstSample = 0; ///< of the block under way
    std::atomic<uint64_t> paths{0}, rays{0};

    Implementation(const Scene& scene, const Camera& c, const RenderSettings& s, unsigned threads)
        : expanded(scene.placements.empty() ? std::nullopt
                                            : std::optional(expandPlacements(scene))),
          world(expanded ? expanded->scene : scene, s.estimator.conventions), camera(c),
          settings(s), filter(s.estimator.filter, s.estimator.filterShape), original(scene),
          arena(std::min(threads == 0 ? INT_MAX : int(threads), tbb::info::default_concurrency())) {
    }

    /// The numbers of a sample; a pure function of pixel and index.
    reference::RandomStream randomOf(uint32_t pixel, uint32_t index) const {
        const PixelPlace place = settings.area.placeOf(pixel);
        return {place.y * settings.area.width + place.x, index, settings.estimator.seed,
                settings.estimator.sampler};
    }

    struct CameraSample {
        reference::Ray ray;
        double weight; ///< by the pixel filter
    };
    /// Takes the sample's first numbers.
    CameraSample cameraRayOf(uint32_t pixel, reference::RandomStream& random) const {
        const PictureArea& area = settings.area;
        const PixelPlace place = area.placeOf(pixel);
        const double u = random.next(), v = random.next();
        const reference::FilterSample at = filter.sample(u, v);
        glm::dvec2 onLens(0);
        if (camera.lensRadius > 0) {
            random.beginBlock();
            const double radius = std::sqrt(random.next()), turn = random.next();
            onLens = radius * glm::dvec2(std::cos(2 * reference::kPi * turn),
                                         std::sin(2 * reference::kPi * turn));
        }
        return {reference::cameraRay(camera, (place.x + at.place.x) / area.width,
                                     (place.y + at.place.y) / area.height, onLens),
                at.weight};
    }

    struct Sample {
        glm::dvec3 radiance;
        double weight;
    };
    Sample take(uint32_t pixel, uint32_t index, uint64_t& rayCount) const {
        reference::RandomStream random = randomOf(pixel, index);
        const auto [ray, weight] = cameraRayOf(pixel, random);
        reference::PathSample path(world, settings.estimator, random);
        const Integrator integrator = settings.estimator.integrator;
        const glm::dvec3 value = integrator == Integrator::Normals ? path.normalColor(ray)
                                 : integrator == Integrator::Depth
                                     ? path.depth(ray)
                                     : path.radiance(ray, camera.medium);
        rayCount += path.rays();
        return {value, weight};
    }

    /// What is seen, in terms of the scene that the backend was made for.
    void name(SeenPixel& seen) const {
        if (!expanded || seen.primitive == kNothingSeen) return;
        const size_t triangles = expanded->triangleOf.size();
        if (seen.primitive >= triangles) {
            seen.primitive += uint32_t(original.triangles.size() - triangles);
            return;
        }
        seen.placement = expanded->placementOf[seen.primitive];
        // Where a mirror turned the triangle over, its second and third corner are the other way.
        if (seen.placement != kInNoPlacement &&
            matricesOf(original.placements[seen.placement]).mirrors)
            std::swap(seen.b1, seen.b2);
        seen.primitive = expanded->triangleOf[seen.primitive];
    }

    /// Likewise of a path.
    void name(RecordedPath& path) const {
        if (!expanded) return;
        const auto rename = [&](uint32_t& primitive, uint32_t* placement) {
            if (primitive == kNotNamed) return;
            SeenPixel seen;
            seen.primitive = primitive;
            name(seen);
            primitive = seen.primitive;
            if (placement) *placement = seen.placement;
        };
        for (RecordedVertex& vertex : path.vertices) {
            if (!vertex.returns) rename(vertex.primitive, &vertex.placement);
            for (RecordedLight& light : vertex.lights)
                rename(light.primitive, nullptr);
        }
        const RecordedVertex* split = nullptr;
        for (RecordedVertex& vertex : path.vertices) {
            if (vertex.branch == 0) split = &vertex;
            if (!vertex.returns || split == nullptr) continue;
            vertex.primitive = split->primitive;
            vertex.placement = split->placement;
        }
    }

    /// The samples of a pixel are taken in order by one thread: their statistics are rounded, and
    /// so depend on the order.
    void fill(const PixelTarget& target, PixelStatistics& pixel, PassReport& report) {
        constexpr uint32_t kSamplesPerReport = 64;
        while (pixel.taken() < target.samples && !report.stopped()) {
            const uint32_t first = pixel.taken();
            const uint32_t count = std::min(kSamplesPerReport, target.samples - first);
            uint64_t rayCount = 0;
            for (uint32_t i = first; i < first + count; ++i) {
                const Sample sample = take(target.pixel, firstSample + i, rayCount);
                pixel.add(sample.radiance, sample.weight);
            }
            paths += count;
            rays += rayCount;
            report.add(count);
        }
    }
};

uint64_t referenceBytes(const Scene& scene) {
    // Of the tree: two nodes of a primitive, its place and, while it is built, its box.
    constexpr uint64_t kPerPrimitive = 2 * 64 + sizeof(uint32_t) + 48;
    uint64_t copies = 0; // of placed triangles
    if (!scene.placements.empty())
        copies = scene.placedTriangles() * (sizeof(Triangle) + 3 * sizeof(glm::vec3));
    return kPerPrimitive * (scene.placedTriangles() + scene.spheres.size()) + copies;
}

ReferenceBackend::ReferenceBackend(const Scene& scene, const Camera& camera,
                                   const RenderSettings& settings, unsigned threads)
    : implementation_(std::make_unique<Implementation>(scene, camera, settings, threads)) {
    if (settings.estimator.lightSamples == 0) throw std::invalid_argument("lightSamples is 0");
}

ReferenceBackend::~ReferenceBackend() = default;

void ReferenceBackend::sample(std::span<const PixelTarget> targets, Film& film,
                              const PassProgress& progress) {
    const RenderSettings& settings = implementation_->settings;
    if (film.pixels.size() != settings.area.pixelCount())
        throw std::invalid_argument("the film is not the size of what is rendered");
    for (const PixelTarget& target : targets)
        if (target.pixel >= film.pixels.size())
            throw std::invalid_argument("pixel " + std::to_string(target.pixel) +
                                        " is not in the film");

    PassReport report(progress);
    implementation_->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, targets.size()), [&](const auto& range) {
            for (size_t i = range.begin(); i != range.end(); ++i)
                implementation_->fill(targets[i], film.pixels[targets[i].pixel], report);
        });
    });
    report.finish();
}

void ReferenceBackend::beginAt(uint32_t firstSample) {
    implementation_->firstSample = firstSample;
}

SampleValue ReferenceBackend::sampleAlone(uint32_t pixel, uint32_t sample) {
    uint64_t rays = 0;
    const auto [radiance, weight] = implementation_->take(pixel, sample, rays);
    implementation_->paths += 1;
    implementation_->rays += rays;
    PixelStatistics statistics;
    statistics.add(radiance);
    return {weight * radiance, statistics.rejected > 0};
}

RecordedPath ReferenceBackend::record(uint32_t pixel, uint32_t sample) {
    const Implementation& all = *implementation_;
    if (all.settings.estimator.integrator != Integrator::Path)
        throw std::invalid_argument("only paths are recorded");
    reference::RandomStream random = all.randomOf(pixel, sample);
    const auto [ray, weight] = all.cameraRayOf(pixel, random);
    RecordedPath path;
    path.origin = ray.origin;
    path.direction = ray.direction;
    path.tMin = ray.tMin;
    path.filterWeight = weight;
    path.branches = all.settings.estimator.branches;
    reference::PathSample sampled(all.world, all.settings.estimator, random);
    sampled.recordTo(path);
    const glm::dvec3 radiance = sampled.radiance(ray, all.camera.medium);
    PixelStatistics statistics;
    statistics.add(radiance);
    path.radiance = weight * radiance;
    path.rejected = statistics.rejected > 0;
    all.name(path);
    return path;
}

bool ReferenceBackend::mayRetrace() const {
    const Implementation& all = *implementation_;
    return all.world.scene.media.empty() &&
           all.settings.estimator.conventions == ShadingConventions{};
}

RecordedPath ReferenceBackend::retrace(const RecordedPath& taken) const {
    const Implementation& all = *implementation_;
    if (!mayRetrace()) throw std::invalid_argument("the scene's paths cannot be retraced");
    reference::PathSample path(all.world, all.settings.estimator, all.randomOf(0, 0));
    RecordedPath own = path.retrace(taken);
    all.name(own);
    return own;
}

std::vector<SeenPixel> ReferenceBackend::see(uint32_t first, std::span<const uint32_t> samples,
                                             Seeing what, uint32_t firstSample) {
    std::vector<SeenPixel> seen(samples.size());
    const Implementation& all = *implementation_;
    implementation_->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, seen.size()), [&](const auto& range) {
            for (size_t i = range.begin(); i != range.end(); ++i) {
                for (uint32_t sample = 0; sample < samples[i]; ++sample) {
                    const auto pixel = uint32_t(first + i);
                    reference::RandomStream random = all.randomOf(pixel, firstSample + sample);
                    const auto [ray, weight] = all.cameraRayOf(pixel, random);
                    reference::addSeen(seen[i], all.world, ray, all.camera.medium, weight, random,
                                       what);
                }
                all.name(seen[i]);
            }
        });
    });
    return seen;
}

RenderCounters ReferenceBackend::counters() const {
    return {implementation_->paths, implementation_->rays};
}

} // namespace stromboli
