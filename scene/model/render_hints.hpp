#pragma once

#include <cstdint>
#include <optional>

namespace stromboli {

/// The pixel filters that a scene file can ask for.
enum class HintedFilter { Box, Gaussian };

/// How a scene file wants to be rendered, for formats that say so. It holds where the user says
/// nothing.
struct RenderHints {
    std::optional<uint32_t> width, height; ///< of the picture; both or none
    std::optional<uint32_t> maxBounces;    ///< scatterings at most
    std::optional<HintedFilter> filter;
    bool hidesBackdrop = false; ///< the camera does not see the environment
};

} // namespace stromboli
