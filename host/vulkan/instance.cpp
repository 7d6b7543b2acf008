#include "host/vulkan/instance.hpp"

#include "host/core/error.hpp"
#include "host/core/messages.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

namespace stromboli::vulkan {

// --- Results of calls ----------------------------------------------------------------------------

namespace {

std::string_view name(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialisation failed";
    case VK_ERROR_DEVICE_LOST:
        return "device lost: the driver reset the device; another program, a watchdog or a driver "
               "fault";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "memory map failed";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "feature not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "incompatible driver";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    case VK_TIMEOUT:
        return "timeout";
    default:
        return {};
    }
}

} // namespace

void check(VkResult result, std::string_view operation) {
    if (result == VK_SUCCESS) return;
    const std::string_view text = name(result);
    if (text.empty())
        throw DeviceError(fmt::format("Vulkan: cannot {}: VkResult {}", operation, int(result)));
    if (result == VK_ERROR_DEVICE_LOST)
        throw DeviceLostError(fmt::format("Vulkan: cannot {}: {}", operation, text));
    throw DeviceError(fmt::format("Vulkan: cannot {}: {}", operation, text));
}

// --- The instance --------------------------------------------------------------------------------

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* user) {
    auto& complaints = *static_cast<Instance::Complaints*>(user);
    ++complaints.count;
    tell(complaints.messages, Severity::Error, fmt::format("validation: {}", data->pMessage));
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(Instance::Complaints* complaints) {
    return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
            .pfnUserCallback = onMessage,
            .pUserData = complaints};
}

bool hasLayer(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    for (const VkLayerProperties& layer : layers)
        if (std::strcmp(layer.layerName, name) == 0) return true;
    return false;
}

} // namespace

bool validationRequested() {
    const char* value = std::getenv("STROMBOLI_VALIDATION");
    return value && std::string_view(value) != "0" && *value;
}

Instance::Instance(bool validation, Messages messages)
    : complaints_{.messages = std::move(messages)} {
    if (volkInitialize() != VK_SUCCESS)
        throw DeviceError("no Vulkan loader (libvulkan.so.1) on this machine; on Debian: apt "
                          "install libvulkan1 mesa-vulkan-drivers");
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "stromboli",
                                           .apiVersion = VK_API_VERSION_1_1};
    std::vector<const char*> layers, extensions;
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(&complaints_);
    if (validation) {
        if (!hasLayer(kValidationLayer))
            throw DeviceError("validation was asked for but VK_LAYER_KHRONOS_validation is not "
                              "installed; on Debian: apt install vulkan-validationlayers");
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        info.pNext = &messenger;
    }
    info.enabledLayerCount = uint32_t(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) // the loader's way to say that it found none
        throw DeviceError("no Vulkan driver on this machine; on Debian, without a GPU: apt install "
                          "mesa-vulkan-drivers");
    check(result, "create the instance");
    volkLoadInstanceOnly(instance_);
    destroy_ = vkDestroyInstance;
    if (!validation) return;
    destroyMessenger_ = vkDestroyDebugUtilsMessengerEXT;
    check(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_),
          "listen to the validation layer");
}

Instance::~Instance() {
    if (messenger_) destroyMessenger_(instance_, messenger_, nullptr);
    if (instance_) destroy_(instance_, nullptr);
}

// --- Float controls ------------------------------------------------------------------------------

namespace {

// Numbers of the SPIR-V specification, 3: opcodes, capabilities, execution modes.
constexpr uint32_t kOpExtension = 10, kOpEntryPoint = 15, kOpExecutionMode = 16, kOpCapability = 17,
                   kOpExecutionModeId = 331;
constexpr uint32_t kPreserveCapability = 4466, kPreserveMode = 4461; // SignedZeroInfNanPreserve
constexpr uint32_t kRoundCapability = 4467, kRoundMode = 4462;       // RoundingModeRTE
constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5;
constexpr uint32_t kWidth = 32; ///< bits of the floats that are meant

bool hasExtension(VkPhysicalDevice device) {
    uint32_t count = 0;
    if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS)
        return false;
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    for (const VkExtensionProperties& e : extensions)
        if (std::strcmp(e.extensionName, VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME) == 0)
            return true;
    return false;
}

using Words = std::vector<uint32_t>;

/// The first word of an instruction has its length in words and its opcode.
uint32_t firstWord(uint32_t opcode, size_t words) {
    return uint32_t(words) << 16 | opcode;
}

void append(Words& code, uint32_t opcode, const Words& operands) {
    code.push_back(firstWord(opcode, 1 + operands.size()));
    code.insert(code.end(), operands.begin(), operands.end());
}

/// A literal string: four characters a word, at least one zero at the end.
Words literal(const char* text) {
    Words words(std::strlen(text) / 4 + 1);
    std::memcpy(words.data(), text, std::strlen(text));
    return words;
}

/// Where the sections of a module end that get more instructions, in words from its start, and the
/// functions that are entry points. A module has its sections in a fixed order (SPIR-V, 2.4).
struct Layout {
    size_t capabilitiesEnd = 0, extensionsEnd = 0, modesEnd = 0;
    Words entryPoints;
    bool isValid = false;
};

Layout layoutOf(std::span<const uint32_t> spirv) {
    Layout layout;
    if (spirv.size() < kHeaderWords || spirv[0] != kMagic) return layout;
    for (size_t i = kHeaderWords; i < spirv.size();) {
        const uint32_t opcode = spirv[i] & 0xFFFF, length = spirv[i] >> 16;
        if (length == 0 || length > spirv.size() - i) return layout;
        const size_t end = i + length;
        if (opcode == kOpCapability) layout.capabilitiesEnd = layout.extensionsEnd = end;
        if (opcode == kOpExtension) layout.extensionsEnd = end;
        if (opcode == kOpEntryPoint && length > 2) layout.entryPoints.push_back(spirv[i + 2]);
        if (opcode == kOpEntryPoint || opcode == kOpExecutionMode || opcode == kOpExecutionModeId)
            layout.modesEnd = end;
        i = end;
    }
    layout.isValid = layout.capabilitiesEnd > 0 && layout.modesEnd > layout.extensionsEnd;
    return layout;
}

} // namespace

FloatControls floatControlsOf(VkPhysicalDevice device) {
    if (!hasExtension(device)) return {};
    VkPhysicalDeviceFloatControlsProperties floats = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, .pNext = &floats};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(device, &properties);
    // SwiftShader keeps them anyway, and asked to, takes minutes to compile a kernel.
    if (driver.driverID == VK_DRIVER_ID_GOOGLE_SWIFTSHADER) return {};
    // Without independence all widths would have to ask, also those that the device may not have.
    const bool alone =
        floats.roundingModeIndependence != VK_SHADER_FLOAT_CONTROLS_INDEPENDENCE_NONE;
    return {floats.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE,
            alone && floats.shaderRoundingModeRTEFloat32 == VK_TRUE};
}

std::string inWords(const FloatControls& controls) {
    if (!controls.any()) return "nothing promised of NaN, infinity, -0 and rounding";
    std::string text;
    if (controls.preservesSpecialValues) text = "NaN, infinity and -0 kept";
    if (controls.roundsToEven)
        text += std::string(text.empty() ? "" : ", ") + "rounding to nearest even";
    return text;
}

Words withFloatControls(std::span<const uint32_t> spirv, const FloatControls& controls) {
    const Layout layout = layoutOf(spirv);
    Words code;
    if (!controls.any() || !layout.isValid) return {spirv.begin(), spirv.end()};
    const auto copy = [&](size_t first, size_t end) {
        code.insert(code.end(), spirv.begin() + ptrdiff_t(first), spirv.begin() + ptrdiff_t(end));
    };
    copy(0, layout.capabilitiesEnd);
    if (controls.preservesSpecialValues) append(code, kOpCapability, {kPreserveCapability});
    if (controls.roundsToEven) append(code, kOpCapability, {kRoundCapability});
    copy(layout.capabilitiesEnd, layout.extensionsEnd);
    append(code, kOpExtension, literal("SPV_KHR_float_controls"));
    copy(layout.extensionsEnd, layout.modesEnd);
    for (const uint32_t entry : layout.entryPoints) {
        if (controls.preservesSpecialValues)
            append(code, kOpExecutionMode, {entry, kPreserveMode, kWidth});
        if (controls.roundsToEven) append(code, kOpExecutionMode, {entry, kRoundMode, kWidth});
    }
    copy(layout.modesEnd, spirv.size());
    return code;
}

} // namespace stromboli::vulkan
