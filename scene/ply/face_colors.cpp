#include "scene/ply/face_colors.hpp"

#include "scene/model/srgb.hpp"
#include "scene/ply/vertices.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::ply {

FaceColors::FaceColors(const Element& faces, const std::string& name) : isColor_(name == "color") {
    for (const Property& property : faces.properties) {
        const std::optional<int> channel = channelOfAttribute(property, name);
        if (channel && !channels_[size_t(*channel)]) channels_[size_t(*channel)] = &property;
    }
}

std::optional<int> FaceColors::channelOf(const Property& property) const {
    for (int c = 0; c < 3; ++c)
        if (channels_[size_t(c)] == &property) return c;
    return std::nullopt;
}

void FaceColors::set(const Property& property, double value) {
    if (!isColor_) {
        color_[*channelOf(property)] = std::isfinite(float(value)) ? float(value) : 0;
        if (!channels_[2]) color_ = glm::vec3(color_.x);
        return;
    }
    const double scale = fullScale(property.type);
    const double part = std::isfinite(value) ? std::max(value, 0.0) / scale : 0;
    color_[*channelOf(property)] = float(scale == 1 ? part : srgbToLinear(std::min(part, 1.0)));
}

} // namespace stromboli::ply
