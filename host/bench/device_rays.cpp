#include "host/bench/device_rays.hpp"

#include "embedded/trace_rays_storage.h"
#include "embedded/trace_rays_texel.h"
#include "host/bvh/cpu_traversal.hpp"
#include "host/core/error.hpp"
#include "host/kernel/dispatcher.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/reference/camera.hpp"
#include "host/reference/integrator.hpp"
#include "host/reference/sampling.hpp"
#include "host/vulkan/queue.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace stromboli::bench {

// --- Sets of rays --------------------------------------------------------------------------------

namespace {

using reference::SurfacePoint;

constexpr float kInfinite = std::numeric_limits<float>::max();
/// The share of a shadow ray, at its end, where nothing counts: far more than any contestant's
/// rounding, so that none of them takes the emitter for an obstacle.
constexpr float kEmitterGap = 0x1p-12f;

/// What became of one camera ray.
struct PathStart {
    gpu::TracedRay camera{};
    std::optional<gpu::TracedRay> shadow, bounce;
};

/// The kernel's bound of a hit point's error (docs/theory/numerics.md, "Hit points"): 32 u of the
/// largest coordinate.
double floatError(const glm::dvec3& p) {
    return 32 * 0x1p-24 * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

gpu::TracedRay leave(const SurfacePoint& s, const glm::dvec3& direction, float tMax) {
    const glm::dvec3 origin =
        reference::moveOff(s.position, floatError(s.position), s.geometric, direction);
    return {glm::vec3(origin), tMax, glm::vec3(direction), 0};
}

std::optional<gpu::TracedRay> shadowRay(const reference::Lights& lights, const SurfacePoint& s,
                                        reference::RandomStream& random) {
    const size_t count = lights.broadCount() + lights.deltaCount();
    if (count == 0) return {};
    const auto index = size_t(random.next() * double(count));
    const reference::LightSample light =
        index < lights.broadCount() ? lights.sampleBroad(index, s, random)
                                    : lights.sampleDelta(index - lights.broadCount(), s, random);
    const bool lit = light.value.x > 0 || light.value.y > 0 || light.value.z > 0;
    if (!lit || glm::dot(s.geometric, light.direction) <= 0) return {};
    if (light.infinite) return leave(s, light.direction, kInfinite);
    gpu::TracedRay ray = leave(s, light.direction, 1 - kEmitterGap);
    ray.direction = glm::vec3(light.target - glm::dvec3(ray.origin));
    return ray;
}

gpu::TracedRay bounceRay(const SurfacePoint& s, reference::RandomStream& random) {
    const double u = random.next(), v = random.next();
    const reference::Frame frame(s.shading);
    glm::dvec3 direction = frame.toWorld(reference::cosineHemisphere(u, v));
    // Interpolated normals may send it into the surface; a path would end there.
    if (glm::dot(direction, s.geometric) <= 0)
        direction -= 2 * glm::dot(direction, s.geometric) * s.geometric;
    return leave(s, direction, kInfinite);
}

/// Jittered.
reference::Ray cameraRay(const Camera& camera, const RenderSettings& settings, uint32_t pixel,
                         reference::RandomStream& random) {
    const double x = pixel % settings.area.width + random.next();
    const double y = pixel / settings.area.width + random.next();
    return reference::cameraRay(camera, x / settings.area.width, y / settings.area.height);
}

gpu::TracedRay rounded(const reference::Ray& ray) {
    return {glm::vec3(ray.origin), kInfinite, glm::vec3(ray.direction), 0};
}

PathStart startPath(const reference::World& world, const Camera& camera,
                    const RenderSettings& settings, uint32_t pixel, uint32_t sample) {
    reference::RandomStream random(pixel, sample, settings.estimator.seed);
    const reference::Ray ray = cameraRay(camera, settings, pixel, random);
    PathStart start;
    start.camera = rounded(ray);
    const reference::Hit hit = world.bvh.closest(ray, {});
    if (hit.primitive == reference::kNoPrimitive) return start;
    SurfacePoint surface = reference::surfaceAt(world.scene, ray, hit);
    reference::faceForward(surface, world.conventions);
    start.shadow = shadowRay(world.lights, surface, random);
    start.bounce = bounceRay(surface, random);
    return start;
}

/// All pixels in tiles of 8 x 8; tiles that follow each other are far apart in the picture.
/// lavapipe gives each of its threads one contiguous share of a dispatch, and none shall have the
/// empty half.
std::vector<PixelTarget> pixelsInOrder(const RenderSettings& settings) {
    std::vector<PixelTarget> pixels(size_t(settings.area.width) * settings.area.height);
    for (uint32_t i = 0; i < pixels.size(); ++i)
        pixels[i].pixel = i;
    const std::vector<PixelTarget> tiled = tileOrder(pixels, settings.area.width);
    constexpr size_t kTile = 64, kStride = 61;
    const size_t tiles = (tiled.size() + kTile - 1) / kTile;
    std::vector<PixelTarget> order;
    for (size_t start = 0; start < kStride; ++start)
        for (size_t tile = start; tile < tiles; tile += kStride) {
            const auto first = tiled.begin() + ptrdiff_t(tile * kTile);
            const size_t count = std::min(kTile, tiled.size() - tile * kTile);
            order.insert(order.end(), first, first + ptrdiff_t(count));
        }
    return order;
}

/// startOf: what becomes of the camera ray of a pixel's sample.
RaySets collect(const RenderSettings& settings, uint32_t perPixel,
                const std::function<PathStart(uint32_t pixel, uint32_t sample)>& startOf) {
    const std::vector<PixelTarget> order = pixelsInOrder(settings);
    std::vector<PathStart> starts(order.size() * perPixel);
    tbb::parallel_for(size_t(0), starts.size(), [&](size_t i) {
        starts[i] = startOf(order[i % order.size()].pixel, uint32_t(i / order.size()));
    });
    RaySets sets;
    for (const PathStart& start : starts) {
        sets.camera.rays.push_back(start.camera);
        if (start.shadow) sets.shadow.rays.push_back(*start.shadow);
        if (start.bounce) sets.bounce.rays.push_back(*start.bounce);
    }
    return sets;
}

/// A triangle that was hit, in the world.
SurfacePoint flatSurface(const Scene& scene, const WideLayout& layout, const TraversalRay& ray,
                         const TraversalHit& hit) {
    const gpu::LeafRecord leaf = asLeaf(layout.records[hit.primitive / 2]);
    std::array<glm::vec3, 3> corner = {leaf.p0, leaf.p1, leaf.p2};
    if (hit.primitive % 2 == 1) corner = {leaf.p0, leaf.p2, leaf.p3};
    if (hit.placement != gpu::NO_PLACEMENT) {
        const uint32_t number =
            asPlacement(layout.records[hit.placement]).placement & ~gpu::PLACEMENT_MIRRORS;
        for (glm::vec3& c : corner)
            c = placed(scene.placements[number], c);
    }
    const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
    SurfacePoint s{};
    s.position = a + double(hit.b1) * (b - a) + double(hit.b2) * (c - a);
    s.geometric = glm::normalize(glm::cross(b - a, c - a));
    if (glm::dot(s.geometric, glm::dvec3(ray.direction)) > 0) s.geometric = -s.geometric;
    s.shading = s.geometric;
    return s;
}

} // namespace

RaySets makeRaySets(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                    uint32_t perPixel) {
    const reference::World world(scene, {});
    return collect(settings, perPixel, [&](uint32_t pixel, uint32_t sample) {
        return startPath(world, camera, settings, pixel, sample);
    });
}

RaySets makePlacedRaySets(const Scene& scene, const WideLayout& layout, const Camera& camera,
                          const RenderSettings& settings, uint32_t perPixel) {
    return collect(settings, perPixel, [&](uint32_t pixel, uint32_t sample) {
        reference::RandomStream random(pixel, sample, settings.estimator.seed);
        PathStart start;
        start.camera = rounded(cameraRay(camera, settings, pixel, random));
        TraversalRay ray;
        ray.origin = start.camera.origin, ray.direction = start.camera.direction;
        const TraversalHit hit = closestHit(layout, ray);
        if (!hit) return start;
        const SurfacePoint surface = flatSurface(scene, layout, ray, hit);
        start.shadow = bounceRay(surface, random);
        start.bounce = bounceRay(surface, random);
        return start;
    });
}

// --- Rays on the device --------------------------------------------------------------------------

namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

constexpr uint32_t kBindings = BINDING_RAY_DISTANCES + 1;
/// Byte offset of the lanes' totals in their buffer: they follow the number of the next chunk of
/// rays.
constexpr uint64_t kTotalsOffset = sizeof(uint32_t);

/// The scene's buffers by binding; the traversal reads the first ones only, but all are bound.
auto sceneRows(const GpuScene& scene) {
    const std::array rows = {
        std::as_bytes(std::span(scene.bvh.records)),  std::as_bytes(std::span(scene.primitives)),
        std::as_bytes(std::span(scene.materials)),    std::as_bytes(std::span(scene.lights.lights)),
        std::as_bytes(std::span(scene.lights.table)), std::as_bytes(scene.lights.environmentRows()),
        std::as_bytes(std::span(scene.details.rows))};
    static_assert(rows.size() == SCENE_BINDING_COUNT);
    return rows;
}

std::span<const uint32_t> rayKernel(bool texelFetch) {
    if (texelFetch) return trace_rays_texel;
    return trace_rays_storage;
}

bool isRow(uint32_t binding) {
    return binding < SCENE_BINDING_COUNT || binding == BINDING_RAYS;
}

std::vector<vulkan::Binding> bindings(bool texelFetch) {
    std::vector<vulkan::Binding> all;
    for (uint32_t i = 0; i < kBindings; ++i)
        if (isRow(i) || i > BINDING_RAYS)
            all.push_back({i, isRow(i) && texelFetch ? BufferUse::Texel : BufferUse::Storage});
    return all;
}

} // namespace

uint64_t rowBytes(const GpuScene& scene, uint64_t mostRays) {
    return std::max(largestSceneBuffer(scene), mostRays * sizeof(gpu::TracedRay));
}

RayTuning rayTuning(const vulkan::Device& device, uint64_t rowBytes) {
    RayTuning t = {resolve({}, device, rowBytes), 1};
    if (!device.description().isCpu()) return t;
    // The service pass costs next to nothing here (the path kernel's is dear), so that it comes
    // after every step. Rays per lane: enough that lanes seldom wait for the last rays of others,
    // few enough for the limit of loop passes.
    t.kernel.traversalSteps = 1;
    t.raysPerLane = 64;
    return t;
}

DeviceRays::DeviceRays(const vulkan::Device& device, const GpuScene& scene, const RayTuning& tuning)
    : device_(device), tuning_(tuning), code_(rayKernel(tuning.kernel.texelFetch)), queue_(device) {
    const KernelFeatures features = kernelFeatures(scene, {}, {}, tuning_.kernel);
    constants_.assign(features.begin(), features.end());
    for (const std::span<const std::byte> rows : sceneRows(scene)) {
        Buffer& buffer = sceneBuffers_.emplace_back(device, "scene of the ray kernel", rows.size(),
                                                    tuning_.kernel.texelFetch ? BufferUse::Texel
                                                                              : BufferUse::Storage);
        buffer.upload(queue_, rows);
    }
}

vulkan::ComputePipeline DeviceRays::makePipeline(bool anyHit, bool writeDistances) const {
    std::vector<uint32_t> constants = constants_;
    constants.push_back(anyHit);
    constants.push_back(writeDistances);
    return {device_, code_, bindings(tuning_.kernel.texelFetch), constants,
            sizeof(gpu::RayDispatch)};
}

/// On a CPU device, where a group is a subgroup.
bool DeviceRays::groupsTakeChunks() const {
    return tuning_.kernel.driverThreads > 0 &&
           tuning_.kernel.workgroupSize == device_.description().subgroupSize;
}

void DeviceRays::load(const RaySet& set) {
    rayCount_ = uint32_t(set.rays.size());
    anyHit_ = set.anyHit;
    const uint32_t raysPerGroup = tuning_.kernel.workgroupSize * tuning_.raysPerLane;
    chunks_ = (rayCount_ + raysPerGroup - 1) / raysPerGroup;
    // There are twice as many groups as chunks, so that a fast thread can take up to twice its
    // share.
    groups_ = groupsTakeChunks() ? 2 * chunks_ : chunks_;
    rays_.emplace(device_, "ray buffer", set.rays.size() * sizeof(gpu::TracedRay),
                  tuning_.kernel.texelFetch ? BufferUse::Texel : BufferUse::Storage);
    rays_->upload(queue_, std::as_bytes(std::span(set.rays)));
    totals_.emplace(device_, "ray totals",
                    kTotalsOffset +
                        groups_ * tuning_.kernel.workgroupSize * sizeof(gpu::LaneTotals),
                    BufferUse::Storage);
    distances_.emplace(device_, "ray distances", rayCount_ * sizeof(float), BufferUse::Storage);
    pipeline_.emplace(makePipeline(anyHit_, false));
    set_ = makeSet(*pipeline_);
}

std::unique_ptr<vulkan::DescriptorSet>
DeviceRays::makeSet(const vulkan::ComputePipeline& pipeline) const {
    std::vector<const Buffer*> buffers;
    for (const Buffer& b : sceneBuffers_)
        buffers.push_back(&b);
    for (const Buffer* b : {&*rays_, &*totals_, &*distances_})
        buffers.push_back(b);
    return std::make_unique<vulkan::DescriptorSet>(device_, pipeline, buffers);
}

double DeviceRays::dispatch(const vulkan::ComputePipeline& pipeline,
                            const vulkan::DescriptorSet& set) {
    gpu::RayDispatch constants{};
    constants.rayCount = rayCount_;
    constants.raysPerLane = tuning_.raysPerLane;
    constants.chunkCount = groupsTakeChunks() ? chunks_ : 0;
    // An iteration counts for itself, its traversal steps and the service loop.
    constants.hardIterations = loopLimit(device_, 1 + (tuning_.kernel.traversalSteps + 1) + 2);
    const uint32_t nextChunk = 0;
    totals_->upload(queue_, std::as_bytes(std::span(&nextChunk, 1)));
    return queue_.run("run the ray kernel", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline, set,
                               std::as_bytes(std::span(&constants, 1)), groups_);
    });
}

RayTotals DeviceRays::trace() {
    const double seconds = dispatch(*pipeline_, *set_);
    std::vector<gpu::LaneTotals> lanes(groups_ * tuning_.kernel.workgroupSize);
    totals_->download(queue_, std::as_writable_bytes(std::span(lanes)), kTotalsOffset);
    RayTotals totals;
    totals.deviceSeconds = device_.description().timestampBits > 0 ? seconds : 0;
    uint64_t unfinished = 0;
    for (const gpu::LaneTotals& lane : lanes) {
        totals.hits += lane.hits;
        totals.distances += double(lane.distances);
        unfinished += lane.unfinished;
    }
    if (unfinished > 0)
        throw DeviceError(fmt::format("the ray kernel did not finish: {} of {} lanes met the limit "
                                      "of loop passes",
                                      unfinished, lanes.size()));
    return totals;
}

std::vector<float> DeviceRays::distances() {
    const vulkan::ComputePipeline pipeline = makePipeline(anyHit_, true);
    dispatch(pipeline, *makeSet(pipeline));
    std::vector<float> result(rayCount_);
    distances_->download(queue_, std::as_writable_bytes(std::span(result)));
    return result;
}

} // namespace stromboli::bench
