#pragma once

#include "scene/model/texture.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace stromboli::build {

/// What was read of a file, kept for its next reading: the moments of an animation differ in what
/// is made of it.
class FileStore {
  public:
    /// The picture of this key, which is read if it is not there yet.
    const TextureImage& picture(const std::string& key, const std::function<TextureImage()>& read) {
        const auto found = pictures_.find(key);
        return found != pictures_.end() ? found->second
                                        : pictures_.emplace(key, read()).first->second;
    }

    /// What a loader keeps of a file beside its pictures; made if it is not there yet. A key is of
    /// one type.
    template <class Parts>
    std::shared_ptr<Parts> parts(const std::string& key,
                                 const std::function<std::shared_ptr<Parts>()>& make) {
        std::shared_ptr<void>& kept = parts_[key];
        if (!kept) kept = make();
        return std::static_pointer_cast<Parts>(kept);
    }

  private:
    std::map<std::string, TextureImage> pictures_;
    std::map<std::string, std::shared_ptr<void>> parts_;
};

} // namespace stromboli::build
