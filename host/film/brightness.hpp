#pragma once

#include "host/film/film.hpp"
#include "host/film/tone.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace stromboli {

/// How a picture comes out on a scale that ends at black and at white.
struct Brightness {
    bool unlit = false;    ///< no pixel has any radiance
    double darkShare = 0;  ///< of the pixels that are shown as black
    double whiteShare = 0; ///< of the pixels in which a channel is above white
    /// Brings the pixel that is brighter than 95 of 100 lit ones to white, in powers of two;
    /// of a lit picture.
    std::optional<double> exposure;
};

Brightness brightnessOf(const Film& film, const ToneCurve& tone);

/// A part of a picture.
struct PartBrightness {
    Brightness brightness;
    uint64_t pixels = 0;
};

/// Of a picture in parts. The exposure is that of the brightest part.
Brightness togetherOf(std::span<const PartBrightness> parts);

} // namespace stromboli
