#include "host/film/image.hpp"

namespace stromboli {

std::vector<float>& FloatImage::channel(const std::string& name) {
    return channels.try_emplace(name, size_t(width) * height).first->second;
}

} // namespace stromboli
