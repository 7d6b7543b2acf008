#pragma once

#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <cstdint>

namespace stromboli {

/// A checksum (CRC-32) of all that a picture of the scene through this camera depends on: another
/// scene, or the same file read in another way, has another one but for one chance in 2^32. Names
/// do not count.
uint32_t sceneIdentity(const Scene& scene, const Camera& camera);

/// The same of an environment alone.
uint32_t environmentIdentity(const Environment& environment);

} // namespace stromboli
