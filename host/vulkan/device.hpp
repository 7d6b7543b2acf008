#pragma once

#include "host/vulkan/instance.hpp"
#include "host/vulkan/pipeline_cache.hpp"
#include "host/vulkan/specialised_modules.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::vulkan {

// --- The device ----------------------------------------------------------------------------------

/// What a physical device is and whether the renderer can use it.
struct DeviceDescription {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    std::string uuid;   ///< tells twin devices apart
    std::string driver; ///< name and version, as the driver states them
    uint32_t subgroupSize = 0;
    /// Lanes that kernels ask for in a subgroup, in place of the driver's choice; 0: they do not.
    uint32_t askedSubgroupSize = 0;
    uint64_t memory = 0; ///< largest device-local heap, bytes; 0: a driver without hardware
    uint64_t largestAllocation = 0; ///< maxMemoryAllocationSize, bytes
    bool readsHostPages = false;    ///< shaders of a CPU can read pages of the host where they lie
    int queueFamily = -1;           ///< with compute; -1: none
    uint32_t timestampBits = 0;
    FloatControls floatControls; ///< that kernels ask for
    std::string missing;         ///< why it cannot be used; empty: it can

    bool usable() const { return missing.empty(); }
    std::string name() const { return properties.deviceName; }
    std::string type() const; ///< "discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"
    bool isCpu() const { return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    /// Device memory is the host's memory: buffers are mapped instead of copied.
    bool sharesHostMemory() const;
};

/// All devices in the loader's order.
std::vector<DeviceDescription> listDevices(const Instance& instance);

/// What a device is opened for.
enum class DeviceUse {
    Rendering,
    /// Its driver is to say what it makes of kernels (compute_pipeline.hpp). It may be a driver
    /// without hardware, such as RADV with RADV_FORCE_FAMILY, which crashes when a device is
    /// destroyed (Mesa 22.3): such a device is left to the end of the process.
    Compiling,
};

/// A logical device with one compute queue.
class Device {
  public:
    /// `cache`: where pipelines and modules are kept between runs; none: they are not. Throws
    /// DeviceError if the device cannot be opened, or cannot do what it is opened for.
    Device(const Instance& instance, const DeviceDescription& description,
           std::optional<BlobCache> cache = std::nullopt, DeviceUse use = DeviceUse::Rendering);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return device_; }
    /// Whether pipelines are made so that their statistics can be asked for.
    bool keepsStatistics() const { return use_ == DeviceUse::Compiling; }
    VkQueue queue() const { return queue_; }
    const DeviceDescription& description() const { return description_; }
    const VkPhysicalDeviceLimits& limits() const { return description_.properties.limits; }
    /// The calls of this device (volk's table: no trampoline, several devices at once are fine).
    const VolkDeviceTable& vk() const { return table_; }
    const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
    /// Pass it to the creation of pipelines; may be VK_NULL_HANDLE.
    VkPipelineCache pipelineCache() const { return pipelines_->handle(); }
    /// Bytes of compiled pipelines that an earlier run left in the cache.
    size_t pipelineBytesFound() const { return pipelines_->bytesFound(); }
    const SpecialisedModules& specialisedModules() const { return modules_; }
    /// Compute pipelines that are made already.
    KeptPipelines& keptPipelines() const { return kept_; }
    /// Device memory that the buffers of this device take now, bytes.
    uint64_t allocatedBytes() const { return allocated_.load(); }
    /// What a buffer tells the device it is made on.
    void countAllocation(int64_t bytes) const { allocated_ += uint64_t(bytes); }
    /// Compute pipelines that were compiled on this device so far.
    uint64_t pipelinesMade() const { return pipelinesMade_.load(); }
    /// What a pipeline tells the device it is made on.
    void countPipeline() const { ++pipelinesMade_; }
    /// Bytes that were uploaded to buffers of this device so far.
    uint64_t bytesUploaded() const { return uploaded_.load(); }
    void countUpload(uint64_t bytes) const { uploaded_ += bytes; }

  private:
    DeviceDescription description_;
    DeviceUse use_;
    VkPhysicalDeviceMemoryProperties memory_{};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VolkDeviceTable table_{};
    SpecialisedModules modules_;
    std::unique_ptr<PipelineCache> pipelines_;
    mutable KeptPipelines kept_;
    mutable std::atomic<uint64_t> allocated_ = 0, pipelinesMade_ = 0, uploaded_ = 0;
};

// --- Choosing one --------------------------------------------------------------------------------

struct DeviceChoice {
    size_t index = 0;
    std::string reason;
};

/// Picks by `wanted`: empty (the best usable one: discrete, integrated, virtual, CPU, other), a
/// number in the list, "cpu", a UUID or part of a name (case-insensitive, must be unique).
/// Throws DeviceError if nothing fits or the device lacks something, saying what.
DeviceChoice chooseDevice(const std::vector<DeviceDescription>& devices, const std::string& wanted);

/// One or several: "all" (every usable one; those that are the host's own processor only where
/// there is no other), or what chooseDevice understands, with commas between (a name with a comma
/// in it is taken for a name). Throws DeviceError as chooseDevice does.
std::vector<DeviceChoice> chooseDevices(const std::vector<DeviceDescription>& devices,
                                        const std::string& wanted);

// --- Opening one ---------------------------------------------------------------------------------

/// An instance and the device chosen from it, kept together in the right order of destruction.
struct OpenDevice {
    std::unique_ptr<Instance> instance;
    std::unique_ptr<Device> device;
    DeviceChoice choice;
};

/// Opens the device `wanted` names (chooseDevice), with the validation layer if the environment
/// asks for it, and with the pipelines that earlier runs kept in the user's cache folder.
/// `messages` is told of that cache, and what the validation layer says, on any thread. Throws
/// DeviceError.
OpenDevice openDevice(const std::string& wanted, const Messages& messages = {});

/// The devices that `wanted` names (chooseDevices), each with an instance of its own; a device that
/// is named twice is opened twice. Throws DeviceError.
std::vector<OpenDevice> openDevices(const std::string& wanted, const Messages& messages = {});

/// Throws DeviceError if the validation layer had anything to say.
void requireNoValidationMessages(const OpenDevice& open);

} // namespace stromboli::vulkan
