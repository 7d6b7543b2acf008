#pragma once

#include "host/core/user_cache.hpp"
#include "host/vulkan/instance.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli::vulkan {

// --- The pipeline cache --------------------------------------------------------------------------

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

// --- Pipelines kept in memory --------------------------------------------------------------------

/// A compiled compute shader and its layouts (compute_pipeline.hpp).
struct CompiledPipeline;

/// The pipelines that were made on a device, by all that they are made from, so that the same one
/// is compiled once however many pictures, seeds or sessions ask for it. Safe to use from many
/// threads.
class KeptPipelines {
  public:
    /// The code by its hash, its length, bindings, constants and bytes of push constants.
    using Key = std::vector<uint64_t>;
    using Made = std::shared_ptr<const CompiledPipeline>;

    /// The one of that key, which `make` makes if there is none.
    Made get(const Key& key, const std::function<Made()>& make);
    /// Forgets all; those in use live until their users leave them.
    void clear();

    /// A scene needs two or three. Before there would be more than this, all are forgotten, so that
    /// a study of many scenes does not keep the machine code of each.
    static constexpr size_t kMost = 32;

  private:
    std::mutex mutex_;
    std::map<Key, Made> made_;
};

} // namespace stromboli::vulkan
