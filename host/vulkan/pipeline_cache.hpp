#pragma once

#include "host/core/user_cache.hpp"
#include "host/vulkan/handle.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli::vulkan {

/// The pipelines a driver has compiled, kept between runs as far as the driver gives them out.
/// What was kept is given to the driver only if its header (VkPipelineCacheHeaderVersionOne) names
/// this device and this build of the driver. Nothing here ever fails: without a cache, or with a
/// useless one, pipelines are compiled.
class PipelineCache {
  public:
    /// `kept`: where to keep it; none: for this run only. `vk` must outlive it.
    PipelineCache(VkDevice device, const VolkDeviceTable& vk,
                  const VkPhysicalDeviceProperties& properties, std::optional<BlobCache> kept);
    ~PipelineCache() { save(); }
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    /// VK_NULL_HANDLE if the driver could not make one.
    VkPipelineCache handle() const { return cache_.get(); }
    /// Bytes that an earlier run left and the driver was given.
    size_t bytesFound() const { return found_.size(); }
    /// Keeps what the driver has by now, if that is more than a header and not what was found.
    void save() noexcept;

  private:
    std::vector<std::byte> data() const;

    VkDevice device_;
    const VolkDeviceTable& vk_;
    std::optional<BlobCache> kept_;
    std::string name_;
    std::vector<std::byte> found_;
    Handle<VkPipelineCache> cache_;
};

/// The name a device's pipelines are kept under: one for each device and version of its driver.
std::string pipelineCacheName(const VkPhysicalDeviceProperties& properties);

/// True if `data` begins with a header of version one that names this device and driver.
bool isPipelineCacheOf(const VkPhysicalDeviceProperties& properties,
                       std::span<const std::byte> data);

} // namespace stromboli::vulkan
