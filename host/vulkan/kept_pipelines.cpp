#include "host/vulkan/kept_pipelines.hpp"

namespace stromboli::vulkan {

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
