#include "host/check/cross_check.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/render.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

Film renderWatched(Backend& backend, const Job& job, const std::string& who) {
    nowDoing(fmt::format("taking samples {}", who), StatusLine::OfOthers);
    ProgressBar bar;
    return render(backend, job.settings, [&](const RenderProgress& progress) {
        bar.show(progress);
        return true;
    });
}

} // namespace

int checkCommand(const Options& options) {
    std::future<vulkan::OpenDevice> device = openDeviceMeanwhile(options);
    const Job job = prepareJob(options);
    const BuiltScene built = buildScene(job);
    const vulkan::OpenDevice open = device.get();
    Film onDevice;
    {
        VulkanBackend backend(*open.device, built.gpu, job.camera, job.settings);
        onDevice = renderWatched(backend, job, "on the device");
    }
    ReferenceBackend reference(job.scene, job.camera, job.settings, options.threads);
    const Film onHost = renderWatched(reference, job, "with the reference");

    CheckSettings settings;
    settings.familyError = options.familyWiseError;
    const CheckResult result = crossCheck(onDevice, onHost, settings);
    fmt::print("A: {}\nB: CPU reference (double precision)\n{}", open.device->description().name(),
               formatCheck(result));
    vulkan::requireNoValidationMessages(open);
    switch (result.verdict()) {
    case Verdict::Different:
        return int(ExitCode::Device);
    case Verdict::Undecided:
        return int(ExitCode::Undecided);
    case Verdict::Agree:
        break;
    }
    return int(ExitCode::Success);
}

} // namespace stromboli
