#pragma once

#include "scene/gltf/context.hpp"

namespace stromboli::gltf {

/// Places a camera of the file.
void placeCamera(Context& context, const Element& camera, const std::string& name,
                 const glm::dmat4& toWorld);

} // namespace stromboli::gltf
