#pragma once

namespace stromboli {

/// What this build calls itself: "0.1.0", or of a git checkout "0.1.0+12.gabcdef1"
/// (cmake/GitVersion.cmake).
const char* version();

} // namespace stromboli
