#include "host/kernel/kernel_report.hpp"

#include "host/kernel/path_kernel.hpp"
#include "shaders/shared/wavefront_types.h"

#include <optional>

namespace stromboli {

std::vector<KernelReport> reportKernels(const vulkan::Device& device, const GpuScene& scene,
                                        const Camera& camera, const Estimator& estimator) {
    struct Kernel {
        const char* name;
        std::optional<uint32_t> stage;
    };
    // Those that begin and stop a render run once.
    const Kernel kernels[] = {{"persistent", std::nullopt},
                              {"depart", gpu::STAGE_DEPART},
                              {"trace", gpu::STAGE_TRACE},
                              {"follow", gpu::STAGE_FOLLOW},
                              {"light", gpu::STAGE_LIGHT}};
    const DeviceTuning tuning = resolve({.texelFetch = false}, device);
    const KernelFeatures features = kernelFeatures(scene, camera, estimator, tuning);
    std::vector<KernelReport> reports;
    for (const Kernel& k : kernels) {
        const PathKernel kernel(device, features, tuning.texelFetch, vulkan::Specialiser::Ours,
                                k.stage);
        reports.push_back({k.name, statisticsOf(device, kernel.pipeline().handle())});
    }
    return reports;
}

} // namespace stromboli
