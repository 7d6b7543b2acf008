#pragma once

#include "host/core/user_cache.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli::vulkan {

/// Modules with their constants in place (host/spirv), kept between runs: to make one takes a
/// quarter of the start of a small scene, and the kernels of the same scenes are asked for again
/// and again. What was kept is used only if it was made of the same code and constants by the same
/// specialiser.
class SpecialisedModules {
  public:
    /// They are kept in a folder of their own within the cache; none: nowhere.
    explicit SpecialisedModules(const std::optional<BlobCache>& cache) {
        if (cache) kept_ = cache->within("kernels", kMostKept);
    }

    /// As spirv::specialise(), by which it is made if it was not kept.
    std::optional<std::vector<uint32_t>> get(std::span<const uint32_t> module,
                                             std::span<const uint32_t> constants) const;

    /// Words of the smallest module that is kept: a smaller one is made in the time that it takes
    /// to find a file.
    static constexpr size_t kLeastWords = size_t(1) << 17;
    /// Files in the cache: some 10 MB.
    static constexpr size_t kMostKept = 32;

  private:
    std::optional<BlobCache> kept_;
};

} // namespace stromboli::vulkan
