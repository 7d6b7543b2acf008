#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/vulkan/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace stromboli {
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
    fmt::print("     subgroup: {} lanes; timestamps: {}\n", d.subgroupSize,
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
    const vulkan::Instance instance(vulkan::validationRequested());
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

} // namespace stromboli
