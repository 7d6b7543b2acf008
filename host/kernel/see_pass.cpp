#include "host/kernel/see_pass.hpp"

#include "host/core/error.hpp"
#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/loop_limit.hpp"

#include "embedded/see_storage.h"
#include "embedded/see_texel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stromboli {
namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

constexpr double kTargetSeconds = 0.1; ///< of a dispatch, as KernelTuning has it

/// One iteration of the loop counts for itself, its traversal steps and pixel filter, and the loose
/// textures of a material.
uint32_t hardLimit(const vulkan::Device& device, const GpuScene& scene,
                   std::span<const uint32_t> constants) {
    return loopLimit(device, 1 + passesOfCameraRays(constants) + (scene.mostTextures + 1));
}

std::vector<vulkan::Binding> bindings(bool texelFetch) {
    std::vector<vulkan::Binding> all;
    for (uint32_t i = 0; i < SCENE_BINDING_COUNT; ++i)
        all.push_back({i, texelFetch ? BufferUse::Texel : BufferUse::Storage});
    all.push_back({BINDING_FRAME, BufferUse::Uniform});
    all.push_back({BINDING_FILTER, texelFetch ? BufferUse::Texel : BufferUse::Storage});
    all.push_back({BINDING_SEEN_PIXELS, BufferUse::Storage});
    all.push_back({BINDING_SEEN_STATUS, BufferUse::Storage});
    return all;
}

std::vector<const Buffer*> buffersOf(const DeviceScene& scene,
                                     std::initializer_list<const Buffer*> more) {
    std::vector<const Buffer*> buffers;
    for (const Buffer& b : scene.buffers())
        buffers.push_back(&b);
    buffers.insert(buffers.end(), more);
    return buffers;
}

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

} // namespace

std::vector<uint32_t> seeConstants(const GpuScene& scene, const Camera& camera,
                                   const Estimator& settings, const DeviceTuning& tuning,
                                   Seeing what) {
    Estimator estimator = settings;
    // That of normals asks for what is there, and for no material.
    estimator.integrator = what == Seeing::Coverage ? Integrator::Normals : Integrator::Path;
    const KernelFeatures f = kernelFeatures(scene, camera, estimator, tuning);
    std::vector<uint32_t> constants(f.begin(), f.end());
    constants.push_back(what == Seeing::Surfaces);
    return constants;
}

vulkan::ComputePipeline makeSeePipeline(const vulkan::Device& device,
                                        const std::vector<uint32_t>& constants,
                                        const DeviceTuning& tuning) {
    const std::span<const uint32_t> code =
        tuning.texelFetch ? std::span<const uint32_t>(see_texel) : see_storage;
    return {device, code, bindings(tuning.texelFetch), constants, sizeof(gpu::SeeDispatch)};
}

SeePass::SeePass(const vulkan::Device& device, const DeviceScene& scene,
                 const vulkan::ComputePipeline& pipeline, std::span<const uint32_t> constants,
                 const vulkan::Buffer& filter, const gpu::Frame& frame, const DeviceTuning& tuning,
                 uint32_t pixels)
    : device_(device), pipeline_(pipeline), tuning_(tuning), pixelCount_(pixels),
      hardIterations_(hardLimit(device, scene.scene(), constants)), queue_(device),
      frame_(device, "frame constants", sizeof(gpu::Frame), BufferUse::Uniform),
      pixels_(device, "layers", pixels * sizeof(gpu::SeenPixel), BufferUse::Storage),
      status_(device, "status of the layers", sizeof(gpu::SeeStatus), BufferUse::Storage),
      set_(device, pipeline, buffersOf(scene, {&frame_, &filter, &pixels_, &status_})) {
    frame_.upload(queue_, bytesOf(frame));
}

gpu::SeeStatus SeePass::dispatch(uint32_t softIterations) {
    const gpu::SeeDispatch constants{pixelCount_, softIterations, hardIterations_};
    gpu::SeeStatus status{};
    status_.upload(queue_, bytesOf(status));
    const uint32_t groups = (pixelCount_ + tuning_.workgroupSize - 1) / tuning_.workgroupSize;
    seconds_ = queue_.run("look at the scene", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline_, set_, bytesOf(constants), groups);
    });
    status_.download(queue_, std::as_writable_bytes(std::span(&status, 1)));
    return status;
}

void SeePass::run(std::vector<gpu::SeenPixel>& pixels) {
    pixels_.upload(queue_, std::as_bytes(std::span(pixels)));
    DispatchPace pace(kTargetSeconds, std::max(hardIterations_ / 2, 1u));
    gpu::SeeStatus status{};
    do {
        status = dispatch(pace.iterations());
        pace.took(seconds_);
        if (status.overflowedPixels > 0)
            throw DeviceError(fmt::format(
                "the camera rays of {} pixels needed more than {} loop iterations, the most that "
                "{} runs in a dispatch: too many transparent layers behind each other",
                status.overflowedPixels, hardIterations_, device_.description().name()));
    } while (status.unfinishedPixels > 0);
    pixels_.download(queue_, std::as_writable_bytes(std::span(pixels)));
}

SeenPixel seenPixelOf(const gpu::SeenPixel& pixel, const GpuScene& scene) {
    SeenPixel seen;
    seen.samples = pixel.samples;
    seen.hits = pixel.hits;
    seen.covered = pixel.covered;
    seen.albedo = pixel.albedo;
    seen.normal = pixel.normal;
    seen.position = pixel.position;
    if (pixel.primitive == kNothingSeen) return seen;
    seen.primitive = scene.bvh.primitiveOrder[pixel.primitive];
    seen.placement = pixel.placement;
    std::array<double, 3> weights{};
    const std::array<double, 3> ofSlot = {1 - double(pixel.b1) - pixel.b2, pixel.b1, pixel.b2};
    for (size_t c = 0; c < 3; ++c)
        weights[(c + scene.bvh.firstCorner[seen.primitive]) % 3] = ofSlot[c];
    seen.b1 = weights[1];
    seen.b2 = weights[2];
    return seen;
}

} // namespace stromboli
