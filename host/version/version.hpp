#pragma once

namespace stromboli {

/// What this build calls itself: "0.1.0", or of a git checkout "0.1.0+12.gabcdef1"
/// (cmake/GitVersion.cmake).
const char* version();

/// 16 hexadecimal digits, the same in builds that take the same samples of a scene in memory: of
/// the code that does it, and of the compilers (cmake/RenderingCode.cmake).
const char* renderingCode();

} // namespace stromboli
