#include "host/vulkan/instance.hpp"

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/vulkan/result.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

namespace stromboli::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* counter) {
    ++*static_cast<std::atomic<uint32_t>*>(counter);
    logging::error(fmt::format("validation: {}", data->pMessage));
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(std::atomic<uint32_t>* counter) {
    return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
            .pfnUserCallback = onMessage,
            .pUserData = counter};
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

Instance::Instance(bool validation) {
    if (volkInitialize() != VK_SUCCESS)
        throw DeviceError("no Vulkan loader (libvulkan.so.1) on this machine; on Debian: apt "
                          "install libvulkan1 mesa-vulkan-drivers");
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "stromboli",
                                           .apiVersion = VK_API_VERSION_1_1};
    std::vector<const char*> layers, extensions;
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(&messages_);
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

} // namespace stromboli::vulkan
