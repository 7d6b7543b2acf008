#pragma once

#include "scene/ply/header.hpp"

#include <glm/glm.hpp>

#include <array>
#include <optional>
#include <string>

namespace stromboli::ply {

/// The colours of faces, as vertices have them too.
class FaceColors {
  public:
    FaceColors(const Element& faces, const std::string& name);

    bool areThere() const { return channels_[0] && (!isColor_ || (channels_[1] && channels_[2])); }
    bool isColor(const Property& property) const { return channelOf(property).has_value(); }
    /// What the face at hand says.
    void set(const Property& property, double value);
    glm::vec3 color() const { return color_; }

  private:
    std::optional<int> channelOf(const Property& property) const;

    bool isColor_;                              ///< and no other attribute
    std::array<const Property*, 3> channels_{}; ///< red, green and blue; null: none
    glm::vec3 color_{1};
};

} // namespace stromboli::ply
