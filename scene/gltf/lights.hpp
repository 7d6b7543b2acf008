#pragma once

#include "scene/gltf/context.hpp"

namespace stromboli::gltf {

/// Places a light of KHR_lights_punctual. Candela and lux are taken as watts per steradian and per
/// square metre.
void placeLight(Context& context, const Element& light, const std::string& name,
                const glm::dmat4& toWorld);

} // namespace stromboli::gltf
