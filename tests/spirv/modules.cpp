#include "tests/spirv/modules.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"
#include "scene/read_scene.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/shell.hpp"

#include <fstream>

namespace stromboli::test {

std::string complaint(const Words& code) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.spv", std::ios::binary)
        .write(reinterpret_cast<const char*>(code.data()),
               std::streamsize(code.size() * sizeof(uint32_t)));
    const ShellRun run =
        shell(STROMBOLI_SPIRV_VAL " --target-env vulkan1.1 " + (folder / "a.spv").string());
    return run.exitCode == 0 ? "" : run.output;
}

Words featuresOf(const std::string& name, bool everythingOn) {
    const Scene scene = readScene(name);
    DeviceTuning tuning;
    tuning.workgroupSize = 8;
    tuning.everythingOn = everythingOn;
    const RenderSettings settings;
    const KernelFeatures f = kernelFeatures(
        packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator)),
        makeCamera(scene, CameraChoice::Automatic, 64, 48), settings.estimator, tuning);
    return {f.begin(), f.end()};
}

} // namespace stromboli::test
