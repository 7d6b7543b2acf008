#pragma once

#include "scene/model/texture.hpp"

#include <functional>
#include <map>
#include <string>

namespace stromboli::build {

/// Pictures that were decoded, kept for the next reading of the same file: the moments of an
/// animation differ in other things.
class PictureStore {
  public:
    /// The picture of this key, which is read if it is not there yet.
    const TextureImage& get(const std::string& key, const std::function<TextureImage()>& read) {
        const auto found = pictures_.find(key);
        return found != pictures_.end() ? found->second
                                        : pictures_.emplace(key, read()).first->second;
    }

  private:
    std::map<std::string, TextureImage> pictures_;
};

} // namespace stromboli::build
