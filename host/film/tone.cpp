#include "host/film/tone.hpp"

#include <cmath>
#include <numbers>

namespace stromboli {

/// Clamps to [0, 1]; NaN gives 0.
static double unitInterval(double value) {
    if (!(value > 0)) return 0;
    return value < 1 ? value : 1;
}

double srgbFromLinear(double linear) {
    const double l = unitInterval(linear);
    return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

double linearFromSrgb(double signal) {
    const double s = unitInterval(signal);
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double radianceFromCs184(uint8_t byte) {
    return std::pow((byte + 0.5) / 255, 2.2) / std::numbers::sqrt2;
}

uint8_t ToneCurve::toByte(double radiance) const {
    if (!(radiance > 0)) return 0;
    const double exposed = std::exp2(exposure) * radiance;
    if (kind == Kind::Srgb) return static_cast<uint8_t>(255 * srgbFromLinear(exposed) + 0.5);
    const double signal = std::pow(std::numbers::sqrt2 * exposed, 1 / 2.2);
    return static_cast<uint8_t>(255 * unitInterval(signal));
}

} // namespace stromboli
