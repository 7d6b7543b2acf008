#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace stromboli {

/// The pixel filters that a scene file can ask for.
enum class HintedFilter { Box, Gaussian, Tent, Mitchell, CatmullRom, Lanczos };

/// The numbers of such a filter.
struct HintedFilterShape {
    double deviation = 0.5;          ///< Gaussian, pixels
    double radius = 1;               ///< Tent, pixels
    double b = 1.0 / 3, c = 1.0 / 3; ///< Mitchell and Netravali's B and C
    uint32_t lobes = 3;              ///< Lanczos
};

/// How a scene file wants to be rendered, for formats that say so. It holds where the user says
/// nothing.
struct RenderHints {
    std::optional<uint32_t> width, height; ///< of the picture; both or none
    /// A part of that picture: left, top, width, height in pixels.
    std::optional<std::array<uint32_t, 4>> crop;
    std::optional<uint32_t> maxBounces; ///< scatterings at most
    std::optional<HintedFilter> filter;
    HintedFilterShape filterShape;
    std::optional<uint32_t> rouletteStart; ///< scatterings before Russian roulette
    bool hidesBackdrop = false;            ///< the camera does not see the environment
    bool showsDepth = false; ///< the picture is of distances from the camera, not of light
};

} // namespace stromboli
