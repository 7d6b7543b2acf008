#include "host/cli/renderer.hpp"

#include "host/cli/seen_channels.hpp"
#include "host/core/log.hpp"
#include "host/core/memory.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/bands.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

/// What a film and all that belongs to it may take.
uint64_t memoryForFilms(const Options& options) {
    return options.filmMebibytes ? uint64_t(*options.filmMebibytes) << 20 : physicalMemory() / 2;
}

uint64_t bytesPerPixel(const Job& job, const Options& options) {
    return hostBytesPerPixel(job.settings.budget.isInBlocks()) +
           seenChannelNames(options).size() * sizeof(float);
}

} // namespace

Renderer::Renderer(const Options& options) {
    if (options.backend == BackendChoice::Vulkan)
        devices_.emplace(options.device, options.scheduler);
}

void Renderer::render(const Job& job, const Options& options, const TakeSamples& take,
                      RenderReport& report) {
    if (devices_)
        renderOnDevice(job, options, take, report);
    else
        renderOnReference(job, options, take, report);
}

void Renderer::openAndBuild(const Job& job, const Options& options, RenderReport& report) {
    const auto build = [&](uint64_t gatheredRows) {
        auto built = std::make_unique<BuiltScene>(
            buildScene(job, options.reading.selection.isFrame ? &kept_ : nullptr, gatheredRows));
        devices_->setScene(built->gpu);
        built_ = std::move(built);
        isStale_ = false;
        report.buildSeconds = built_->buildSeconds;
    };
    if (!built_ || isStale_) build(kUsualGatheredRows);
    devices_->open(); // began while the scene was built
    if (!devices_->haveRoomForTextures(built_->gpu)) build(0);
    report.backend = devices_->name();
}

void Renderer::renderOnDevice(const Job& job, const Options& options, const TakeSamples& take,
                              RenderReport& report) {
    openAndBuild(job, options, report);
    take(
        [&](const RenderSettings& settings, bool again) {
            if (again) devices_->reopen(); // those of the last try are lost
            return devices_->backendFor(job.camera, settings);
        },
        [&] { return devices_->viewer(); },
        devices_->pixelsThatFit(built_->gpu, job.settings.estimator, memoryForFilms(options),
                                bytesPerPixel(job, options)),
        report);
    devices_->requireNoValidationMessages();
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
        [&] { return backend.get(); }, memoryForFilms(options) / bytesPerPixel(job, options),
        report);
}

} // namespace stromboli
