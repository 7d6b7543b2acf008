#include "host/cli/renderer.hpp"

#include "host/cli/seen_channels.hpp"
#include "host/core/log.hpp"
#include "host/core/memory.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/bands.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

/// As many as half of the host's memory, and the device's, have room for.
uint64_t pixelsThatFit(const Job& job, const Options& options, uint64_t onDevice,
                       uint64_t deviceBytesPerPixel) {
    const uint64_t memory =
        options.filmMebibytes ? uint64_t(*options.filmMebibytes) << 20 : physicalMemory() / 2;
    const uint64_t beside = seenChannelNames(options).size() * sizeof(float);
    const uint64_t host = hostBytesPerPixel(job.settings.budget.isInBlocks());
    return std::min(memory / (host + deviceBytesPerPixel + beside), onDevice);
}

} // namespace

Renderer::Renderer(const Options& options) : isOnDevice_(options.backend == BackendChoice::Vulkan) {
    if (isOnDevice_) device_ = openDeviceMeanwhile(options);
}

void Renderer::render(const Job& job, const Options& options, const TakeSamples& take,
                      RenderReport& report) {
    if (isOnDevice_)
        renderOnDevice(job, options, take, report);
    else
        renderOnReference(job, options, take, report);
}

void Renderer::openAndBuild(const Job& job, RenderReport& report) {
    if (!built_ || isStale_) {
        auto built = std::make_unique<BuiltScene>(buildScene(job));
        if (backend_) backend_->setScene(built->gpu);
        built_ = std::move(built);
        isStale_ = false;
        report.buildSeconds = built_->buildSeconds;
    }
    if (!open_) open_ = device_.get();
    report.backend = open_->device->description().name();
}

std::shared_ptr<Backend> Renderer::backendFor(const Job& job, const RenderSettings& settings,
                                              const Options& options, bool again) {
    if (again) { // the last one is lost
        backend_.reset();
        open_ = vulkan::openDevice(options.device);
    }
    if (backend_) {
        backend_->setPicture(job.camera, settings);
        return backend_;
    }
    backend_ = std::make_shared<VulkanBackend>(*open_->device, built_->gpu, job.camera, settings);
    for (const std::string& line : describe(backend_->features()))
        if (!again) logging::debug(fmt::format("kernel: {}", line));
    return backend_;
}

void Renderer::renderOnDevice(const Job& job, const Options& options, const TakeSamples& take,
                              RenderReport& report) {
    openAndBuild(job, report);
    const vulkan::DeviceDescription& description = open_->device->description();
    logging::debug(fmt::format("device {}: {} ({})", open_->choice.index, report.backend,
                               open_->choice.reason));
    const uint64_t mostPixels = pixelsThatFit(
        job, options, filmPixelsThatFit(description, built_->gpu, job.settings.estimator),
        description.isCpu() ? sizeof(gpu::PixelState) : 0);
    take([&](const RenderSettings& settings,
             bool again) { return backendFor(job, settings, options, again); },
         [&] { return backend_.get(); }, mostPixels, report);
    vulkan::requireNoValidationMessages(*open_);
}

void Renderer::renderOnReference(const Job& job, const Options& options, const TakeSamples& take,
                                 RenderReport& report) {
    report.backend = "CPU reference (double precision)";
    std::shared_ptr<ReferenceBackend> backend;
    take(
        [&](const RenderSettings& settings, bool) {
            return backend = std::make_shared<ReferenceBackend>(job.scene, job.camera, settings,
                                                                options.threads);
        },
        [&] { return backend.get(); }, pixelsThatFit(job, options, ~uint64_t(0), 0), report);
}

} // namespace stromboli
