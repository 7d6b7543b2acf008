#pragma once

#include "scene/model/material.hpp"

namespace stromboli::stress {

/// Radiance that comes from a point of a closed sphere of this microfacet material at an angle to
/// its normal, in its first colour channel; the inside emits material.emission. Within a sphere a
/// ray arrives at the angle it left with, so that the radiance depends on that angle alone, and
///   L(mu) = emission + integral of f(mu, w) w.z L(w.z) dw,
/// an integral equation in one variable, solved at Gauss-Legendre nodes (Nystroem 1930) in double
/// precision to 1e-6. cosine: of the angle, in (0, 1].
double metalFurnace(const Material& material, double cosine);

} // namespace stromboli::stress
