#pragma once

#include <glm/glm.hpp>

namespace stromboli::reference {

/// f of KHR_materials_sheen, without its colour (Estevez and Kulla 2017). wo, wi: unit vectors in
/// the frame of the shading normal, above the surface.
double sheen(double alpha, const glm::dvec3& wo, const glm::dvec3& wi);

} // namespace stromboli::reference
