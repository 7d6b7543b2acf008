#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace stromboli {

/// The pixel filters that a scene file can ask for.
enum class HintedFilter { Box, Gaussian, Tent };

/// How a scene file wants to be rendered, for formats that say so. It holds where the user says
/// nothing.
struct RenderHints {
    std::optional<uint32_t> width, height; ///< of the picture; both or none
    /// A part of that picture: left, top, width, height in pixels.
    std::optional<std::array<uint32_t, 4>> crop;
    std::optional<uint32_t> maxBounces; ///< scatterings at most
    std::optional<HintedFilter> filter;
    bool hidesBackdrop = false; ///< the camera does not see the environment
};

} // namespace stromboli
