#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace stromboli::vulkan {

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
