#pragma once

#include "scene/generate/strip_mesh.hpp"

namespace stromboli {

/// A trefoil knot with the bark of an old tree: a closed tube, twisted ridges along it and burls
/// on it. 2 * along * around triangles of the material `material`; about its own middle, some 2
/// units wide.
StripMesh gnarledKnot(uint32_t along, uint32_t around, const std::string& material);

} // namespace stromboli
