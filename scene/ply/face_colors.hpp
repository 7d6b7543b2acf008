#pragma once

#include "scene/ply/header.hpp"

#include <glm/glm.hpp>

#include <array>
#include <optional>

namespace stromboli::ply {

/// The colours of faces, as vertices have them too.
class FaceColors {
  public:
    explicit FaceColors(const Element& faces);

    bool areThere() const { return channels_[0] && channels_[1] && channels_[2]; }
    bool isColor(const Property& property) const { return channelOf(property).has_value(); }
    /// What the face at hand says.
    void set(const Property& property, double value);
    glm::vec3 color() const { return color_; }

  private:
    std::optional<int> channelOf(const Property& property) const;

    std::array<const Property*, 3> channels_{}; ///< red, green and blue; null: none
    glm::vec3 color_{1};
};

} // namespace stromboli::ply
