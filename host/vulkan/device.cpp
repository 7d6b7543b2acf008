#include "host/vulkan/device.hpp"

#include "host/core/error.hpp"
#include "host/core/pages.hpp"
#include "host/vulkan/denormals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <string_view>

namespace stromboli::vulkan {

// --- The device ----------------------------------------------------------------------------------

namespace {

void describeQueues(DeviceDescription& d) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(d.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(d.handle, &count, families.data());
    for (uint32_t i = 0; i < count && d.queueFamily < 0; ++i)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) {
            d.queueFamily = int(i);
            d.timestampBits = families[i].timestampValidBits;
        }
}

bool hasExtension(VkPhysicalDevice handle, std::string_view name) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(handle, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(handle, nullptr, &count, extensions.data());
    return std::ranges::any_of(
        extensions, [&](const VkExtensionProperties& e) { return name == e.extensionName; });
}

/// Whether the device reads memory of the host in units of a page (VK_EXT_external_memory_host).
bool importsPages(VkPhysicalDevice handle) {
    if (!hasExtension(handle, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME)) return false;
    VkPhysicalDeviceExternalMemoryHostPropertiesEXT host = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &host};
    vkGetPhysicalDeviceProperties2(handle, &properties);
    return host.minImportedHostPointerAlignment > 0 &&
           kPageBytes % host.minImportedHostPointerAlignment == 0;
}

/// AMD's GPUs since RDNA run a subgroup of 32 lanes in one pass and one of 64 in two, and their
/// drivers choose 64: where paths differ from lane to lane, more lanes wait for each other.
uint32_t subgroupSizeToAskFor(const DeviceDescription& d) {
    constexpr uint32_t kWide = 64, kWanted = 32;
    if (d.isCpu() || d.subgroupSize != kWide ||
        !hasExtension(d.handle, VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME))
        return 0;
    VkPhysicalDeviceSubgroupSizeControlFeaturesEXT control = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES_EXT};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &control};
    vkGetPhysicalDeviceFeatures2(d.handle, &features);
    VkPhysicalDeviceSubgroupSizeControlPropertiesEXT sizes = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES_EXT};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &sizes};
    vkGetPhysicalDeviceProperties2(d.handle, &properties);
    const bool canAsk = control.subgroupSizeControl && sizes.minSubgroupSize <= kWanted &&
                        sizes.maxSubgroupSize >= kWanted &&
                        (sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
    return canAsk ? kWanted : 0;
}

DeviceDescription describe(VkPhysicalDevice handle) {
    DeviceDescription d;
    d.handle = handle;
    vkGetPhysicalDeviceProperties(handle, &d.properties);
    if (d.properties.apiVersion < VK_API_VERSION_1_1) {
        d.missing = "Vulkan 1.1";
        return d;
    }
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceIDProperties identity = {.sType =
                                                 VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
    VkPhysicalDeviceMaintenance3Properties allocation = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES, .pNext = &identity};
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, .pNext = &allocation};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
    if (d.properties.apiVersion >= VK_API_VERSION_1_2) identity.pNext = &driver;
    vkGetPhysicalDeviceProperties2(handle, &properties);
    d.subgroupSize = subgroup.subgroupSize;
    d.askedSubgroupSize = subgroupSizeToAskFor(d);
    d.largestAllocation = allocation.maxMemoryAllocationSize;
    for (uint8_t byte : identity.deviceUUID)
        d.uuid += fmt::format("{:02x}", byte);
    d.driver = driver.driverName[0] ? fmt::format("{} {}", driver.driverName, driver.driverInfo)
                                    : fmt::format("driver {}", d.properties.driverVersion);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(handle, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            d.memory = std::max<uint64_t>(d.memory, memory.memoryHeaps[i].size);
    describeQueues(d);
    d.floatControls = floatControlsOf(handle);
    // A GPU would read through the bus what it reads often.
    d.readsHostPages = d.isCpu() && importsPages(handle);
    constexpr VkSubgroupFeatureFlags kNeeded =
        VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
    if (!(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) ||
        (subgroup.supportedOperations & kNeeded) != kNeeded)
        d.missing = "subgroup votes and ballots in compute shaders";
    if (d.queueFamily < 0) d.missing = "a queue with compute";
    if (d.memory == 0) d.missing = "memory of its own: it only compiles (see 'stromboli kernels')";
    // llvmpipe takes any width; above 16 lanes it was seen to leave out the others.
    if (d.isCpu() && d.subgroupSize > 16)
        d.missing =
            "a right way to run more than 16 lanes; set LP_NATIVE_VECTOR_WIDTH to 512 at most";
    return d;
}

} // namespace

std::string DeviceDescription::type() const {
    switch (properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "CPU";
    default:
        return "other";
    }
}

bool DeviceDescription::sharesHostMemory() const {
    return isCpu() || properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
}

std::vector<DeviceDescription> listDevices(const Instance& instance) {
    const DenormalsAreZero inTheDriversThreads; // which newer versions of lavapipe start here
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance.handle(), &count, nullptr), "list devices");
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance.handle(), &count, handles.data()), "list devices");
    std::vector<DeviceDescription> devices;
    for (VkPhysicalDevice handle : handles)
        devices.push_back(describe(handle));
    return devices;
}

Device::Device(const Instance&, const DeviceDescription& description,
               std::optional<BlobCache> cache, DeviceUse use)
    : description_(description), use_(use), modules_(cache) {
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = uint32_t(description.queueFamily),
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    std::vector<const char*> extensions;
    if (description.readsHostPages)
        extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
    if (description.floatControls.any())
        extensions.push_back(VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE};
    if (use == DeviceUse::Compiling) {
        if (!hasExtension(description.handle, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME))
            throw DeviceError(description.name() +
                              ": its driver does not say what it makes of kernels "
                              "(VK_KHR_pipeline_executable_properties)");
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    }
    VkPhysicalDeviceSubgroupSizeControlFeaturesEXT sizes = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES_EXT,
        .pNext = use == DeviceUse::Compiling ? &statistics : nullptr,
        .subgroupSizeControl = VK_TRUE};
    if (description.askedSubgroupSize > 0)
        extensions.push_back(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME);
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext =
                                         description.askedSubgroupSize > 0 ? &sizes : sizes.pNext,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = uint32_t(extensions.size()),
                                     .ppEnabledExtensionNames = extensions.data()};
    {
        const DenormalsAreZero inTheDriversThreads;
        check(vkCreateDevice(description.handle, &info, nullptr, &device_),
              "open device " + description.name());
    }
    volkLoadDeviceTable(&table_, device_);
    table_.vkGetDeviceQueue(device_, uint32_t(description.queueFamily), 0, &queue_);
    vkGetPhysicalDeviceMemoryProperties(description.handle, &memory_);
    pipelines_ =
        std::make_unique<PipelineCache>(device_, table_, description.properties, std::move(cache));
}

Device::~Device() {
    const bool isWithoutHardware = use_ == DeviceUse::Compiling && description_.memory == 0;
    if (!device_ || isWithoutHardware) return;
    table_.vkDeviceWaitIdle(device_);
    kept_.clear();
    pipelines_.reset();
    table_.vkDestroyDevice(device_, nullptr);
}

// --- Choosing one --------------------------------------------------------------------------------

namespace {

constexpr const char* kAll = "all";

std::string lower(std::string s) {
    std::transform(s.begin(), s.end(), s.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return s;
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 3;
    default:
        return 4;
    }
}

DeviceChoice usable(const std::vector<DeviceDescription>& devices, size_t index,
                    std::string reason) {
    if (!devices[index].usable())
        throw DeviceError(fmt::format("device {} ({}) cannot be used: it lacks {}", index,
                                      devices[index].name(), devices[index].missing));
    return {index, std::move(reason)};
}

DeviceChoice chooseBest(const std::vector<DeviceDescription>& devices) {
    size_t best = devices.size();
    for (size_t i = 0; i < devices.size(); ++i)
        if (devices[i].usable() &&
            (best == devices.size() ||
             rank(devices[i].properties.deviceType) < rank(devices[best].properties.deviceType)))
            best = i;
    if (best == devices.size())
        throw DeviceError(fmt::format("device 0 ({}) cannot be used: it lacks {}",
                                      devices[0].name(), devices[0].missing));
    return {best, fmt::format("first {} among {} device{}", devices[best].type(), devices.size(),
                              devices.size() == 1 ? "" : "s")};
}

bool matches(const DeviceDescription& d, const std::string& wanted) {
    if (wanted == "cpu") return d.isCpu();
    return lower(d.name()).find(wanted) != std::string::npos || lower(d.uuid) == wanted;
}

/// Beside a GPU, drivers of the host's processor would take little work, round in other ways, and
/// take time from the host.
std::vector<DeviceChoice> allUsable(const std::vector<DeviceDescription>& devices) {
    const bool hasGpu = std::ranges::any_of(
        devices, [](const DeviceDescription& d) { return d.usable() && !d.isCpu(); });
    std::vector<DeviceChoice> choices;
    for (size_t i = 0; i < devices.size(); ++i)
        if (devices[i].usable() && !(hasGpu && devices[i].isCpu()))
            choices.push_back({i, fmt::format("one of {} devices", devices.size())});
    if (choices.empty()) choices.push_back(chooseDevice(devices, "")); // which says what is missing
    return choices;
}

bool isPartOfAName(const std::vector<DeviceDescription>& devices, const std::string& wanted) {
    return std::ranges::any_of(
        devices, [&](const DeviceDescription& d) { return matches(d, lower(wanted)); });
}

/// "all", or a list. Names may have commas of their own.
bool namesSeveral(const std::vector<DeviceDescription>& devices, const std::string& wanted) {
    if (lower(wanted) == kAll) return true;
    return wanted.find(',') != std::string::npos && !isPartOfAName(devices, wanted);
}

std::string withoutSpaces(std::string text) {
    while (!text.empty() && text.front() == ' ')
        text.erase(text.begin());
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text;
}

} // namespace

DeviceChoice chooseDevice(const std::vector<DeviceDescription>& devices,
                          const std::string& wanted) {
    if (devices.empty())
        throw DeviceError("no Vulkan device: no driver is installed; on Debian, for a machine "
                          "without a GPU: apt install mesa-vulkan-drivers");
    if (wanted.empty()) return chooseBest(devices);
    size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size()) {
        if (index >= devices.size())
            throw DeviceError(
                fmt::format("there is no device {}: 'stromboli devices' lists 0 to {}", index,
                            devices.size() - 1));
        return usable(devices, index, "asked for by number");
    }
    if (namesSeveral(devices, wanted))
        throw DeviceError(fmt::format("'{}' names several devices: they make pictures and shares "
                                      "of 'render' together, and nothing else",
                                      wanted));
    std::vector<size_t> found;
    for (size_t i = 0; i < devices.size(); ++i)
        if (matches(devices[i], lower(wanted))) found.push_back(i);
    if (found.empty()) {
        std::string names;
        for (const DeviceDescription& device : devices)
            names += (names.empty() ? "" : "; ") + device.name();
        throw DeviceError(fmt::format("no device matches '{}'; there is {}", wanted, names));
    }
    if (found.size() > 1)
        throw DeviceError(fmt::format("{} devices match '{}': give a number or a UUID of "
                                      "'stromboli devices'",
                                      found.size(), wanted));
    return usable(devices, found[0], fmt::format("matches '{}'", wanted));
}

std::vector<DeviceChoice> chooseDevices(const std::vector<DeviceDescription>& devices,
                                        const std::string& wanted) {
    if (!namesSeveral(devices, wanted)) return {chooseDevice(devices, wanted)};
    if (lower(wanted) == kAll) return allUsable(devices);
    std::vector<DeviceChoice> choices;
    std::istringstream list(wanted + (wanted.back() == ',' ? "," : ""));
    for (std::string one; std::getline(list, one, ',');) {
        one = withoutSpaces(std::move(one));
        if (one.empty()) throw DeviceError(fmt::format("'{}' has an empty place", wanted));
        choices.push_back(chooseDevice(devices, one));
    }
    return choices;
}

// --- Opening one ---------------------------------------------------------------------------------

namespace {

OpenDevice opened(std::unique_ptr<Instance> instance, const std::vector<DeviceDescription>& devices,
                  DeviceChoice choice, const Messages& messages) {
    OpenDevice open;
    open.instance = std::move(instance);
    open.choice = std::move(choice);
    std::optional<BlobCache> cache;
    if (const auto folder = userCacheFolder()) cache.emplace(*folder, messages);
    open.device =
        std::make_unique<Device>(*open.instance, devices[open.choice.index], std::move(cache));
    tell(messages, Severity::Detail,
         fmt::format("pipeline cache: {} bytes from earlier runs",
                     open.device->pipelineBytesFound()));
    return open;
}

} // namespace

OpenDevice openDevice(const std::string& wanted, const Messages& messages) {
    auto instance = std::make_unique<Instance>(validationRequested(), messages);
    const std::vector<DeviceDescription> devices = listDevices(*instance);
    return opened(std::move(instance), devices, chooseDevice(devices, wanted), messages);
}

std::vector<OpenDevice> openDevices(const std::string& wanted, const Messages& messages) {
    auto instance = std::make_unique<Instance>(validationRequested(), messages);
    const std::vector<DeviceChoice> choices = chooseDevices(listDevices(*instance), wanted);
    std::vector<OpenDevice> open;
    for (const DeviceChoice& choice : choices) {
        if (!instance) instance = std::make_unique<Instance>(validationRequested(), messages);
        const std::vector<DeviceDescription> devices = listDevices(*instance);
        open.push_back(opened(std::move(instance), devices, choice, messages));
    }
    return open;
}

void requireNoValidationMessages(const OpenDevice& open) {
    if (const uint32_t count = open.instance->validationMessages())
        throw DeviceError(fmt::format("the Vulkan validation layer reported {} messages", count));
}

} // namespace stromboli::vulkan
