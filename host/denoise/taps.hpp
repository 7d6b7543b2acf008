#pragma once

#include "shaders/shared/denoise_types.h"

#include <cstdint>
#include <vector>

namespace stromboli::denoise {

/// Pixels to each side of a pixel that the candidates look at.
inline constexpr int kReach = 10;
/// Rows around a pixel that its result depends on: neighbours of neighbours in the pilot of those
/// in the candidates of those in the window.
inline constexpr uint32_t kHalo =
    uint32_t(kReach + gpu::DENOISE_PILOT_REACH + gpu::DENOISE_WINDOW_REACH);

/// The neighbours that candidates are means over, the pixel itself among them, in the order in
/// which they are added up: all that are near, and of those further away one of each 2 x 2, for
/// which it stands.
std::vector<gpu::DenoiseTap> taps();

} // namespace stromboli::denoise
