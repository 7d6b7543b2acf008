#include "host/vulkan/pipeline_cache.hpp"

#include <fmt/format.h>

#include <cstring>
#include <new>

namespace stromboli::vulkan {

// --- The pipeline cache --------------------------------------------------------------------------

namespace {

/// Empty if the driver cannot make one.
Handle<VkPipelineCache> createCache(VkDevice device, const VolkDeviceTable& vk,
                                    std::span<const std::byte> data) {
    const VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                            .initialDataSize = data.size(),
                                            .pInitialData = data.data()};
    VkPipelineCache cache = VK_NULL_HANDLE;
    if (vk.vkCreatePipelineCache(device, &info, nullptr, &cache) != VK_SUCCESS) return {};
    return {device, cache, vk.vkDestroyPipelineCache};
}

} // namespace

std::string pipelineCacheName(const VkPhysicalDeviceProperties& p) {
    std::string name =
        fmt::format("pipelines-{:04x}-{:04x}-{:08x}-", p.vendorID, p.deviceID, p.driverVersion);
    for (uint8_t byte : p.pipelineCacheUUID)
        name += fmt::format("{:02x}", byte);
    return name;
}

bool isPipelineCacheOf(const VkPhysicalDeviceProperties& p, std::span<const std::byte> data) {
    VkPipelineCacheHeaderVersionOne header;
    if (data.size() < sizeof header) return false;
    std::memcpy(&header, data.data(), sizeof header);
    return header.headerSize >= sizeof header && header.headerSize <= data.size() &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == p.vendorID && header.deviceID == p.deviceID &&
           std::memcmp(header.pipelineCacheUUID, p.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

PipelineCache::PipelineCache(VkDevice device, const VolkDeviceTable& vk,
                             const VkPhysicalDeviceProperties& properties,
                             std::optional<BlobCache> kept)
    : device_(device), vk_(vk), kept_(std::move(kept)), name_(pipelineCacheName(properties)) {
    if (kept_) found_ = kept_->find(name_).value_or(std::vector<std::byte>());
    if (!isPipelineCacheOf(properties, found_)) found_.clear();
    cache_ = createCache(device, vk, found_);
    if (!cache_ && !found_.empty()) {
        found_.clear();
        cache_ = createCache(device, vk, {});
    }
}

/// Empty if the driver does not give it out.
std::vector<std::byte> PipelineCache::data() const {
    size_t bytes = 0;
    if (vk_.vkGetPipelineCacheData(device_, cache_.get(), &bytes, nullptr) != VK_SUCCESS) return {};
    std::vector<std::byte> data(bytes);
    if (vk_.vkGetPipelineCacheData(device_, cache_.get(), &bytes, data.data()) != VK_SUCCESS)
        return {};
    data.resize(bytes);
    return data;
}

void PipelineCache::save() noexcept try {
    if (!cache_ || !kept_) return;
    std::vector<std::byte> now = data();
    if (now.size() <= sizeof(VkPipelineCacheHeaderVersionOne) || now == found_) return;
    kept_->keep(name_, now);
    found_ = std::move(now);
} catch (const std::bad_alloc&) { // no room for a copy of the cache: none is kept
}

// --- Pipelines kept in memory --------------------------------------------------------------------

KeptPipelines::Made KeptPipelines::get(const Key& key, const std::function<Made()>& make) {
    // Held while one is made: another thread that wants the same one waits for it.
    const std::lock_guard lock(mutex_);
    if (const auto found = made_.find(key); found != made_.end()) return found->second;
    Made made = make();
    if (made_.size() == kMost) made_.clear();
    made_.emplace(key, made);
    return made;
}

void KeptPipelines::clear() {
    const std::lock_guard lock(mutex_);
    made_.clear();
}

} // namespace stromboli::vulkan
