#pragma once

#include "host/denoise/noisy_picture.hpp"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace stromboli::denoise {

/// Why Open Image Denoise cannot be used; empty: it can. The library is loaded at the first call.
const std::string& oidnMissing();

/// What Open Image Denoise makes of each half of the samples. It is not told of the error, so that
/// the two results differ by no more than the halves do.
struct OidnHalves {
    std::vector<glm::vec3> first, second;
};

/// The halves mean + deviation and mean - deviation by its filter for ray tracing, with the
/// picture's albedo and normals where these are known; they are rid of their own noise before, as
/// its documentation advises. Throws UsageError where it is not installed, and with what it says.
OidnHalves runOidn(const NoisyPicture& picture);

} // namespace stromboli::denoise
