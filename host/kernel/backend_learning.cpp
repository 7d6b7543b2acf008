// How a backend learns where light samples to an environment arrive, before a picture begins.
#include "host/bvh/cpu_traversal.hpp"
#include "host/core/random.hpp"
#include "host/kernel/light_guide.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/sampling_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace stromboli {

// --- Whether there may be something to gain ------------------------------------------------------

namespace {

/// Where more than this share of the rays from what the camera sees meets nothing, light samples
/// arrive in any case.
constexpr double kOpenShare = 0.3;

/// The share of rays that meet nothing, of those from what the camera sees back into the half space
/// of the camera. It decides only whether learning is tried: where a ray starts need not be exact,
/// and opacity is not looked at.
double openShare(const GpuScene& scene, const Camera& camera) {
    constexpr int kSide = 20, kRays = 4;
    Random random(1);
    int rays = 0, free = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const glm::dvec2 at((i % kSide + 0.5) / kSide * 2 - 1, (i / kSide + 0.5) / kSide * 2 - 1);
        const glm::dvec3 offset =
            at.x * camera.halfWidth * camera.right + at.y * camera.halfHeight * camera.up;
        TraversalRay ray;
        ray.origin = camera.orthographic ? camera.position + offset : camera.position;
        ray.direction =
            glm::normalize(camera.orthographic ? -camera.back : offset - camera.backOfMiddle());
        const TraversalHit hit = closestHit(scene.bvh, ray);
        if (!hit) continue;
        TraversalRay out;
        out.origin = ray.origin + hit.t * (1 - 0x1p-12f) * ray.direction;
        for (int k = 0; k < kRays; ++k) {
            out.direction = random.direction();
            if (glm::dot(out.direction, ray.direction) > 0) out.direction = -out.direction;
            ++rays;
            free += anyHit(scene.bvh, out) ? 0 : 1;
        }
    }
    return rays > 0 ? double(free) / rays : 1;
}

} // namespace

bool liesOpen(const GpuScene& scene, const Camera& camera) {
    return openShare(scene, camera) > kOpenShare;
}

// --- Learning ------------------------------------------------------------------------------------

namespace {

/// Guided light samples take some percent more time, and are not all of a picture's noise.
constexpr double kGainThatPays = 1.25;

PictureArea notedArea(const PictureArea& area) {
    const double pixels = double(area.width) * area.height;
    const double scale = std::min(1.0, std::sqrt(double(kNotedPixels) / pixels));
    return {std::max(uint32_t(area.width * scale), 1u),
            std::max(uint32_t(area.height * scale), 1u),
            {}};
}

} // namespace

std::vector<gpu::LightNote> VulkanBackend::noteLightSamples(const PictureArea& area,
                                                            const gpu::Frame& frame,
                                                            const DeviceTuning& tuning) {
    const uint64_t pixels = area.pixelCount();
    vulkan::Queue queue(device_);
    std::vector<gpu::LightNote> notes(pixels * frame.notedSamples * gpu::GUIDE_VERTICES);
    const auto bytes = std::as_writable_bytes(std::span(notes));
    vulkan::Buffer onDevice(device_, "notes of light samples", bytes.size(), rowUse(tuning));
    onDevice.clear(queue);
    FilmSegment film{
        0, uint32_t(pixels),
        vulkan::Buffer(device_, "film of notes", pixels * sizeof(gpu::PixelState), rowUse(tuning))};
    film.pixels.clear(queue);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < pixels; ++i)
        targets.push_back({i, frame.notedSamples});
    std::vector<gpu::WorkItem> work;
    for (const PixelTarget& t : tileOrder(targets, area.width)) {
        const PixelPlace place = area.placeOf(t.pixel);
        work.push_back({t.pixel, t.samples, place.x, place.y});
    }
    makeDispatcher({&film, 1},
                   kernelsFor(notingFeatures(*scene_, camera_, estimator_, tuning), tuning), frame,
                   tuning, &onDevice)
        ->run(0, work, [](uint64_t) { return true; });
    onDevice.download(queue, bytes);
    return notes;
}

/// Makes the guide of the picture, if it pays. Bands of a picture have the same one.
void VulkanBackend::learn(const DeviceTuning& ofPicture) {
    const PictureArea area = notedArea(area_);
    DeviceTuning tuning = tuningFor(tuning_, device_, *scene_, area);
    tuning.texelFetch = ofPicture.texelFetch; // as the scene was uploaded
    gpu::Frame frame = makeFrame(*scene_, camera_, area, estimator_);
    frame.branches = 1;
    frame.notedSamples = kNotedSamples;
    frame.maxBounces = std::min(frame.maxBounces, gpu::GUIDE_VERTICES);
    frame.seed = ~frame.seed; // samples of their own
    const bool isKnown = learntFor_ && learntFor_->parallel == camera_.orthographic &&
                         sameEstimator(learntFor_->estimator, estimator_) &&
                         std::memcmp(&learntFor_->frame, &frame, sizeof(frame)) == 0;
    if (isKnown) return;
    learntFor_.reset();
    guide_.reset();
    LightGuide guide;
    if (tuning_.guide)
        guide = *tuning_.guide;
    else
        guide = learnLightGuide(noteLightSamples(area, frame, tuning), *scene_->lights.environment);
    if (guide.gain >= kGainThatPays) {
        const auto bytes = std::as_bytes(std::span(guide.rows));
        auto rows =
            std::make_unique<vulkan::Buffer>(device_, "light guide", bytes.size(), rowUse(tuning));
        vulkan::Queue queue(device_);
        rows->upload(queue, bytes);
        guide_ = std::move(rows);
    }
    learntFor_ = LearntFor{frame, estimator_, camera_.orthographic};
}

} // namespace stromboli
