#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/core/printable.hpp"
#include "host/engine/load_scene.hpp"
#include "host/kernel/path_kernel.hpp"
#include "host/vulkan/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli {

// --- devices -------------------------------------------------------------------------------------

namespace {

void print(size_t index, const vulkan::DeviceDescription& d, bool chosen) {
    const VkPhysicalDeviceLimits& limits = d.properties.limits;
    const uint32_t api = d.properties.apiVersion;
    fmt::print("{} {}  {} ({})\n", chosen ? '*' : ' ', index, d.name(), d.type());
    fmt::print("     driver: {}; Vulkan {}.{}.{}\n", d.driver, VK_API_VERSION_MAJOR(api),
               VK_API_VERSION_MINOR(api), VK_API_VERSION_PATCH(api));
    fmt::print("     memory: {} MiB; storage buffers up to {} MiB; texel buffers up to {} k rows\n",
               d.memory >> 20, limits.maxStorageBufferRange >> 20,
               limits.maxTexelBufferElements >> 10);
    fmt::print("     subgroup: {} lanes{}; timestamps: {}\n", d.subgroupSize,
               d.askedSubgroupSize > 0 ? fmt::format(", of kernels {}", d.askedSubgroupSize) : "",
               d.timestampBits ? "yes" : "no (the host's clock is used)");
    fmt::print("     floats: {}\n", inWords(d.floatControls));
    fmt::print("     uuid: {}\n", d.uuid);
    fmt::print("     {}\n", d.usable() ? "usable" : "not usable: lacks " + d.missing);
}

} // namespace

void declareDevices(DeclaredCommand& c) {
    const auto o = std::make_shared<DevicesOptions>();
    declareDevice(c.list, o->device);
    c.finish = [o] { return *o; };
}

int devicesCommand(const DevicesOptions& options) {
    const vulkan::Instance instance(vulkan::validationRequested(), toTerminal().message);
    const std::vector<vulkan::DeviceDescription> devices = vulkan::listDevices(instance);
    const std::vector<vulkan::DeviceChoice> choices =
        vulkan::chooseDevices(devices, options.device);
    const auto isChosen = [&](size_t i) {
        return std::ranges::find(choices, i, &vulkan::DeviceChoice::index) != choices.end();
    };
    for (size_t i = 0; i < devices.size(); ++i)
        print(i, devices[i], isChosen(i));
    fmt::print("* chosen: {}\n", choices.front().reason);
    return 0;
}

// --- kernels -------------------------------------------------------------------------------------

namespace {

/// What Mesa's driver for AMD GPUs is to the Vulkan loader.
std::string radeonManifest() {
    for (const char* folder :
         {"/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"}) {
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(folder, error))
            if (entry.path().filename().string().starts_with("radeon_icd")) return entry.path();
    }
    throw DeviceError(
        "--device-family needs Mesa's driver for AMD GPUs (Debian's "
        "mesa-vulkan-drivers): no radeon_icd*.json is in the Vulkan loader's folders");
}

/// Families that Mesa 22.3 compiles for without hardware. It ends the process at others, so they
/// are refused here.
constexpr std::string_view kFamilies[] = {
    "tahiti",    "pitcairn",  "verde",     "oland",    "hainan",    "bonaire", "kaveri",
    "kabini",    "hawaii",    "tonga",     "iceland",  "carrizo",   "fiji",    "stoney",
    "polaris10", "polaris11", "polaris12", "vegam",    "vega10",    "vega12",  "vega20",
    "raven",     "raven2",    "renoir",    "arcturus", "aldebaran", "navi10",  "navi12",
    "navi14",    "navi21",    "navi22",    "navi23",   "navi24",    "vangogh", "rembrandt",
    "gfx1036",   "gfx1100",   "gfx1101",   "gfx1102"};

/// Has the Vulkan loader find that driver alone, for a GPU of that family, whether there is one or
/// not. The variables are read when the instance is made.
void compileFor(const std::string& family) {
    if (std::ranges::count(kFamilies, family) == 0)
        throw UsageError(fmt::format("--device-family is '{}'; families are {}", printable(family),
                                     fmt::join(kFamilies, ", ")));
    unsetenv("VK_LOADER_DRIVERS_DISABLE");
    setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
    setenv("VK_ICD_FILENAMES", radeonManifest().c_str(), 1);
    setenv("VK_DRIVER_FILES", radeonManifest().c_str(), 1);
}

const vulkan::DeviceDescription& chosen(const std::vector<vulkan::DeviceDescription>& devices,
                                        const KernelsOptions& options) {
    if (options.deviceFamily.empty())
        return devices[vulkan::chooseDevice(devices, options.device.device).index];
    if (devices.empty())
        throw DeviceError("Mesa's driver has no device of family " + options.deviceFamily);
    return devices.front();
}

/// The columns: statistics that decide how many kernels are at work at a time, by the names that
/// drivers give them.
struct Column {
    const char* title;
    std::vector<const char*> names;
};
const std::vector<Column>& columns() {
    static const std::vector<Column> all = {
        {"registers", {"VGPRs", "Register Count", "GRF registers"}},
        {"spilled", {"Spilled VGPRs", "Spill count"}},
        {"scratch", {"Scratch size", "Local Memory Size", "Scratch Memory Size"}},
        {"shared", {"LDS size", "Shared Memory Size"}},
        {"instructions", {"Instructions", "Instruction Count"}},
        {"waves", {"Subgroups per SIMD", "Max Waves"}},
        {"lanes", {"Subgroup Size"}},
    };
    return all;
}

std::string cell(const KernelReport& report, const Column& column) {
    for (const char* name : column.names)
        for (const vulkan::PipelineStatistic& s : report.statistics)
            if (s.name == name) return fmt::format("{:g}", s.value);
    return "-";
}

/// Those of one scene.
void printKernels(const vulkan::Device& device, const KernelsOptions& options) {
    const auto [scene, picture] = preparePicture(options);
    const Estimator& estimator = picture.settings.estimator;
    BuiltScene built = buildScene(*scene.scene, estimator, toTerminal());
    fitToPicture(built.gpu, *scene.scene, picture.camera, estimator);
    nowDoing("compiling", StatusLine::OfOthers);
    const std::vector<KernelReport> reports =
        reportKernels(device, built.gpu, picture.camera, estimator);
    fmt::print("\n{}\n{:<12}", printable(options.scene.source), "kernel");
    for (const Column& column : columns())
        fmt::print(" {:>12}", column.title);
    fmt::print("\n");
    for (const KernelReport& report : reports) {
        fmt::print("{:<12}", report.kernel);
        for (const Column& column : columns())
            fmt::print(" {:>12}", cell(report, column));
        fmt::print("\n");
    }
}

} // namespace

void declareKernels(DeclaredCommand& c) {
    const auto o = std::make_shared<KernelsOptions>();
    const auto asked = std::make_shared<Asked>();
    declareScene(c.list, o->scene, &o->scenes);
    declarePicture(c.list, o->picture, *asked);
    declareEstimator(c.list, *o, *asked);
    declareSampler(c.list, o->picture.estimator.sampler);
    declareDevice(c.list, o->device.device);
    c.list
        .text(
            "--device-family", "F",
            "compile for this family of AMD GPUs, which need not be there: navi21, gfx1100, vega10",
            o->deviceFamily)
        .usually("the device itself")
        .proposes({"navi21", "gfx1100", "vega10"});
    declareHost(c);
    finishesAsPicture(c, o, asked);
}

int kernelsCommand(const KernelsOptions& options) {
    if (!options.deviceFamily.empty()) compileFor(options.deviceFamily);
    const vulkan::Instance instance(vulkan::validationRequested(), toTerminal().message);
    const std::vector<vulkan::DeviceDescription> devices = vulkan::listDevices(instance);
    const vulkan::DeviceDescription& description = chosen(devices, options);
    const vulkan::Device device(instance, description, std::nullopt, vulkan::DeviceUse::Compiling);
    fmt::print("{}, {}\n", printable(description.name()), printable(description.driver));
    for (const std::string& scene : options.scenes) {
        KernelsOptions ofScene = options;
        ofScene.scene.source = scene;
        printKernels(device, ofScene);
    }
    return 0;
}

} // namespace stromboli
