// How a backend learns where light samples to an environment arrive, before a picture begins.
#include "host/core/random.hpp"
#include "host/kernel/feelers.hpp"
#include "host/kernel/glass_before_lights.hpp"
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

} // namespace

bool seesSkyInPart(const GpuScene& scene, const Camera& camera) {
    constexpr uint32_t kSide = 20, kRays = 4;
    Random random(1);
    const SeesThrough glass = scene.glassBeforeLights > 0 ? clearGlassOf(scene) : SeesThrough();
    const Feelers seen = lookAround(scene.bvh, camera, kSide, glass);
    const Feelers once = feelFrom(scene.bvh, seen, kRays, random, glass);
    const double free = shareOfFree(once).value_or(1);
    if (free > 0) return free <= kOpenShare;
    return shareOfFree(feelFrom(scene.bvh, once, kRays, random, glass)).value_or(0) > 0;
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
    frame.notedSamples = notedSamples(area.pixelCount());
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
    if (guide.gain >= kGainThatPays) guide_ = uploaded("light guide", guide.rows, tuning);
    learntFor_ = LearntFor{frame, estimator_, camera_.orthographic};
}

} // namespace stromboli
