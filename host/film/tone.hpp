#pragma once

#include <cstdint>

namespace stromboli {

/// How linear radiance becomes a byte of a picture. Each channel by itself; values above the
/// range are clamped.
struct ToneCurve {
    enum class Kind {
        Srgb,  ///< IEC 61966-2-1 transfer curve, rounded to the nearest byte
        Cs184, ///< floor(255 min(1, (sqrt(2) L)^(1 / 2.2))): the CS184 renderer's curve
    };

    Kind kind = Kind::Srgb;
    double exposure = 0; ///< stops: radiance is multiplied by 2^exposure first

    /// The byte for a radiance; 0 for NaN and for negative values.
    uint8_t toByte(double radiance) const;
};

/// The sRGB transfer curve: linear light in [0, 1] to signal in [0, 1]; clamps its argument.
double srgbFromLinear(double linear);

/// Inverse of srgbFromLinear: signal in [0, 1] to linear light; clamps its argument.
double linearFromSrgb(double signal);

/// The radiance in the middle of the interval that Cs184 (exposure 0) maps to `byte`, on the
/// signal axis: ((byte + 1/2) / 255)^2.2 / sqrt(2).
double radianceFromCs184(uint8_t byte);

} // namespace stromboli
