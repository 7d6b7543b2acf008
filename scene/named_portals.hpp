#pragma once

#include "scene/model/scene.hpp"

#include <string>
#include <vector>

namespace stromboli {

/// Makes portals of the objects of these names, in place of surfaces: of each the smallest
/// rectangle around it, which is said where the object is none. Other portals of the file are
/// forgotten. Nothing happens where there are no names. Throws SceneError where an object does not
/// exist, has several copies, or does not lie in a plane.
void takePortals(Scene& scene, const std::vector<std::string>& names);

} // namespace stromboli
