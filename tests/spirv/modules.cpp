#include "tests/spirv/modules.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"
#include "scene/read_scene.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/shell.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

namespace stromboli::test {

namespace {

void writeWords(const std::string& file, const Words& code) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(code.data()),
               std::streamsize(code.size() * sizeof(uint32_t)));
}

} // namespace

Words readWords(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    Words words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
    return words;
}

std::string complaint(const Words& code) {
    const TemporaryFolder folder;
    writeWords((folder / "a.spv").string(), code);
    const ShellRun run =
        shell(STROMBOLI_SPIRV_VAL " --target-env vulkan1.1 " + (folder / "a.spv").string());
    return run.exitCode == 0 ? "" : run.output;
}

Words optimised(const Words& code, const std::string& passes) {
    const TemporaryFolder folder;
    const std::string spv = (folder / "a.spv").string();
    writeWords(spv, code);
    const ShellRun run = shell(
        fmt::format("{} --target-env=vulkan1.1 {} {} -o {}", STROMBOLI_OPT, passes, spv, spv));
    EXPECT_EQ(run.exitCode, 0) << run.output;
    return readWords(spv);
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
