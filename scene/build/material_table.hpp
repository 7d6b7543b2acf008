#pragma once

#include "scene/build/scene_builder.hpp"

#include <cstdint>
#include <unordered_map>

namespace stromboli::build {

/// The materials of a file by what the loader knows them by (a name, a number, an element). Each is
/// read when it is first used, so that the scene holds those that it needs.
template <typename Key>
class MaterialTable {
  public:
    explicit MaterialTable(SceneBuilder& builder) : builder_(builder) {}

    /// The number of a material; read() returns the Material and is called once per key.
    template <typename Read>
    uint32_t indexOf(const Key& key, Read&& read) {
        if (const auto found = indices_.find(key); found != indices_.end()) return found->second;
        const uint32_t index = builder_.addMaterial(read());
        indices_.emplace(key, index);
        return index;
    }

  private:
    SceneBuilder& builder_;
    std::unordered_map<Key, uint32_t> indices_;
};

} // namespace stromboli::build
