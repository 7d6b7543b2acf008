#pragma once

#include "host/film/image.hpp"
#include "host/film/view_transform.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace stromboli {

// --- Tone curves ---------------------------------------------------------------------------------

/// How linear light becomes a byte of a picture. Each channel by itself; values above the
/// range are clamped.
struct ToneCurve {
    enum class Kind {
        Srgb,  ///< IEC 61966-2-1 transfer curve, rounded to the nearest byte
        Power, ///< floor(255 min(1, (sqrt(2) L)^(1 / 2.2)))
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

/// The radiance in the middle of the interval that Power (exposure 0) maps to `byte`, on the
/// signal axis: ((byte + 1/2) / 255)^2.2 / sqrt(2).
double radianceFromPower(uint8_t byte);

// --- From radiance to signals --------------------------------------------------------------------

/// How linear radiance becomes signals of a screen: white balance, exposure, view, curve, in this
/// order (docs/guide/pictures.md).
struct ToneMapping {
    ToneCurve curve;
    View view = View::Standard; ///< of the sRGB curve; Power has one of its own
    /// The light that shows as white, in kelvin (white_balance.hpp); empty: colours stay as they
    /// are.
    std::optional<double> illuminant = {};
    // Left open, to be found out from the picture (metering.hpp).
    bool metersExposure = false, metersIlluminant = false;

    bool isOpen() const { return metersExposure || metersIlluminant; }
    /// Whether the curve says all.
    bool isCurveAlone() const { return view == View::Standard && !illuminant && !isOpen(); }
};

/// The mapping whose exposure and illuminant, if they are left open, are found out from the
/// channels R, G, B and A of the picture.
ToneMapping resolved(ToneMapping tone, const FloatImage& radiance);

/// "exposure 1.25 EV, white balance 3200 K": what was left open in `asked` and found out; empty if
/// nothing was.
std::string metered(const ToneMapping& asked, const ToneMapping& found);

/// Signals in [0, 1] of linear radiance.
class SignalOfRadiance {
  public:
    /// Nothing of it is left open.
    explicit SignalOfRadiance(const ToneMapping& tone);
    glm::dvec3 operator()(const glm::dvec3& radiance) const;

  private:
    ToneCurve::Kind kind_;
    View view_;
    double scale_;
    std::optional<glm::dmat3> balance_;
};

// --- From signals to whole numbers ---------------------------------------------------------------

/// How the signals of a picture are kept.
struct PictureEncoding {
    uint32_t bits = 8; ///< of a channel: 8, or 16 in PNG
    /// Rounds up in as many pixels as the signal's place between two numbers says, and not to the
    /// nearest, so that slow gradients show no steps.
    bool dithers = false;
    uint32_t quality = 95; ///< of JPEG and WebP, 1 to 100; of WebP 100 is without loss

    /// Whether it is as small a picture as there is, each number of which is the nearest.
    bool isUsual() const { return bits == 8 && !dithers; }
};

/// The number in [0, 1) that dithering adds before it rounds down, by the pixel's place in the
/// whole picture alone: on any part of a picture nearly uniform, and on neighbours far apart.
double ditherThreshold(const PixelPlace& pixel);

/// The channels R, G and B as numbers of 8 or of 16 bits, with alpha if there is a channel A, by
/// which colours are divided then. Nothing of `tone` is left open.
template <class Value>
ScreenImage<Value> toneMap(const FloatImage& radiance, const ToneMapping& tone, bool dithers);

extern template ByteImage toneMap(const FloatImage&, const ToneMapping&, bool);
extern template WordImage toneMap(const FloatImage&, const ToneMapping&, bool);

} // namespace stromboli
