#pragma once

namespace stromboli::build {

/// The share of diffuse light from inside that an interface sends back; ior: inside / outside.
double internalReflection(double ior);

} // namespace stromboli::build
