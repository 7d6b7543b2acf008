#pragma once

namespace stromboli::test {

inline constexpr double kPi = 3.14159265358979323846;
/// Relative error of one rounded operation on floats.
inline constexpr double kRoundoff = 0x1p-24;
/// INFINITE_DISTANCE of the shaders.
inline constexpr float kInfinite = 3.402823466e38f;

} // namespace stromboli::test
