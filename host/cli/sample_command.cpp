// `render` with --pixel and --sample: one sample of one pixel of a picture, by itself.
#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/job.hpp"
#include "host/core/error.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/reference/reference_backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

/// A picture of its size, of which only the one pixel is rendered.
Job prepareJobOfPixel(const Options& options, const SampleName& name) {
    Job job = prepareJob(options);
    if (name.x >= job.settings.area.width || name.y >= job.settings.area.height)
        throw UsageError(fmt::format("--pixel {} {} is not in the picture of {} x {}", name.x,
                                     name.y, job.settings.area.width, job.settings.area.height));
    job.settings.area.crop = {name.x, name.y, 1, 1};
    return job;
}

SampleValue sampleOnDevice(const Job& job, std::future<vulkan::OpenDevice> device, uint32_t pixel,
                           uint32_t sample) {
    const BuiltScene built = buildScene(job);
    const vulkan::OpenDevice open = device.get();
    SampleValue value;
    {
        VulkanBackend backend(*open.device, built.gpu, job.camera, job.settings);
        value = backend.sampleAlone(pixel, sample);
    }
    vulkan::requireNoValidationMessages(open);
    return value;
}

std::string verdict(const SampleValue& value) {
    if (!value.rejected) return "accepted";
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(value.radiance[c])) return "rejected: not finite";
    const double least = std::min({value.radiance.x, value.radiance.y, value.radiance.z});
    return least < 0 ? "rejected: negative" : "rejected: too large";
}

} // namespace

int sampleCommand(const Options& options) {
    const SampleName& name = *options.sampleAlone;
    const bool onDevice = options.backend == BackendChoice::Vulkan;
    std::future<vulkan::OpenDevice> device;
    if (onDevice) device = openDeviceMeanwhile(options);
    const Job job = prepareJobOfPixel(options, name);
    constexpr uint32_t pixel = 0; // the only one
    const SampleValue value =
        onDevice ? sampleOnDevice(job, std::move(device), pixel, name.sample)
                 : ReferenceBackend(job.scene, job.camera, job.settings, options.threads)
                       .sampleAlone(pixel, name.sample);
    nowDoing("printing", StatusLine::OfOthers);
    // Enough digits to tell any two floats, or doubles, apart.
    const int digits = onDevice ? 9 : 17;
    fmt::print("radiance {:.{}g} {:.{}g} {:.{}g}\n{}\n", value.radiance.x, digits, value.radiance.y,
               digits, value.radiance.z, digits, verdict(value));
    return 0;
}

} // namespace stromboli
