#pragma once

#include "scene/model/scene.hpp"
#include "scene/pbrt/version.hpp"

#include <string>

namespace stromboli::test {

/// A scene that another loader has read, in pbrt's words: triangles and spheres of diffuse
/// materials, point and directional lights, emission, and the environment, whose picture is written
/// beside the file that writeFile() writes. Fails the test for anything else.
std::string retold(const Scene& scene, pbrt::Version version);

} // namespace stromboli::test
