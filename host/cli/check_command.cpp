#include "host/check/cross_check.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/render.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

Film renderWatched(Backend& backend, const Job& job, const Options& options) {
    ProgressBar bar(options.verbosity != Verbosity::Quiet);
    return render(backend, job.settings, [&](const RenderProgress& progress) {
        bar.show(progress);
        return !interrupted();
    });
}

} // namespace

int checkCommand(const Options& options) {
    watchForInterrupt();
    std::future<vulkan::OpenDevice> device = openDeviceMeanwhile(options);
    const Job job = prepareJob(options);
    const BuiltScene built = buildScene(job);
    const vulkan::OpenDevice open = device.get();
    Film onDevice;
    {
        VulkanBackend backend(*open.device, built.gpu, job.camera, job.settings);
        onDevice = renderWatched(backend, job, options);
    }
    ReferenceBackend reference(job.scene, job.camera, job.settings, options.threads);
    const Film onHost = renderWatched(reference, job, options);
    if (interrupted()) {
        logging::warn("interrupted before the check was done");
        return kInterruptedExitCode;
    }

    CheckSettings settings;
    settings.familyError = options.familyWiseError;
    const CheckResult result = crossCheck(onDevice, onHost, settings);
    fmt::print("A: {}\nB: CPU reference (double precision)\n{}", open.device->description().name(),
               formatCheck(result));
    vulkan::requireNoValidationMessages(open);
    return result.agree() ? 0 : int(ExitCode::Device);
}

} // namespace stromboli
