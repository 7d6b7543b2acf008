#pragma once

#include "scene/generate/strip_mesh.hpp"

#include <string>

namespace stromboli {

/// `value` with at most `decimals` digits after the point and no zeros at the end.
std::string compactNumber(double value, int decimals);

/// A COLLADA <geometry> with id `id`: positions with `decimals` digits after the point, unit
/// normals with three.
std::string geometryText(const std::string& id, const StripMesh& mesh, int decimals);

/// A <geometry> of one quadrilateral, corners counter-clockwise seen from its front.
std::string quadText(const std::string& id, const glm::dvec3 (&corners)[4],
                     const std::string& material);

/// A Lambert <effect> and the <material> `name` that instances it.
std::string effectText(const std::string& name, const glm::dvec3& albedo,
                       const glm::dvec3& emission = glm::dvec3(0));
std::string materialText(const std::string& name);

/// A <node> that instances the geometry `id`, each material bound to the symbol of its name.
std::string nodeText(const std::string& id, const std::vector<std::string>& materials);

} // namespace stromboli
