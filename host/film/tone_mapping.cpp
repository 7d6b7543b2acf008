#include "host/film/tone_mapping.hpp"

#include "host/film/metering.hpp"
#include "host/film/white_balance.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace stromboli {

// --- Tone curves ---------------------------------------------------------------------------------

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

double radianceFromPower(uint8_t byte) {
    return std::pow((byte + 0.5) / 255, 2.2) / std::numbers::sqrt2;
}

static double powerFromLinear(double linear) {
    return unitInterval(std::pow(std::numbers::sqrt2 * linear, 1 / 2.2));
}

uint8_t ToneCurve::toByte(double radiance) const {
    if (!(radiance > 0)) return 0;
    const double exposed = std::exp2(exposure) * radiance;
    if (kind == Kind::Srgb) return static_cast<uint8_t>(255 * srgbFromLinear(exposed) + 0.5);
    return static_cast<uint8_t>(255 * powerFromLinear(exposed));
}

// --- From radiance to signals --------------------------------------------------------------------

namespace {

/// Colours of the covered parts of a picture's pixels.
class CoveredColors {
  public:
    explicit CoveredColors(const FloatImage& image) {
        for (size_t c = 0; c < 3; ++c)
            colors_[c] = &image.channels.at(kColorChannels[c]);
        const auto alpha = image.channels.find(kAlphaChannel);
        if (alpha != image.channels.end()) alpha_ = &alpha->second;
    }
    bool hasAlpha() const { return alpha_ != nullptr; }
    /// Pixel filters that are negative in places overshoot at edges.
    float alpha(size_t i) const { return alpha_ ? std::clamp((*alpha_)[i], 0.0f, 1.0f) : 1.0f; }
    /// Black where nothing is covered.
    glm::dvec3 at(size_t i) const {
        const double share = alpha(i);
        if (!(share > 0)) return glm::dvec3(0);
        return glm::dvec3((*colors_[0])[i], (*colors_[1])[i], (*colors_[2])[i]) / share;
    }

  private:
    const std::vector<float>* colors_[3] = {};
    const std::vector<float>* alpha_ = nullptr;
};

} // namespace

ToneMapping resolved(ToneMapping tone, const FloatImage& radiance) {
    if (!tone.isOpen()) return tone;
    const CoveredColors covered(radiance);
    std::vector<glm::vec3> colors(size_t(radiance.width) * radiance.height);
    for (size_t i = 0; i < colors.size(); ++i)
        colors[i] = covered.at(i);
    if (tone.metersIlluminant) tone.illuminant = meteredIlluminant(colors);
    if (tone.metersExposure) {
        if (tone.illuminant) {
            const glm::dmat3 balance = whiteBalance(*tone.illuminant);
            for (glm::vec3& color : colors)
                color = balance * glm::dvec3(color);
        }
        tone.curve.exposure = meteredExposure(colors);
    }
    tone.metersExposure = tone.metersIlluminant = false;
    return tone;
}

std::string metered(const ToneMapping& asked, const ToneMapping& found) {
    std::string text;
    if (asked.metersExposure) text = fmt::format("exposure {:.2f} EV", found.curve.exposure);
    if (!asked.metersIlluminant) return text;
    if (!text.empty()) text += ", ";
    return text + (found.illuminant ? fmt::format("white balance {:.0f} K", *found.illuminant)
                                    : "no white balance, for want of light");
}

SignalOfRadiance::SignalOfRadiance(const ToneMapping& tone)
    : kind_(tone.curve.kind), view_(tone.view), scale_(std::exp2(tone.curve.exposure)) {
    if (tone.illuminant) balance_ = whiteBalance(*tone.illuminant);
}

glm::dvec3 SignalOfRadiance::operator()(const glm::dvec3& radiance) const {
    const glm::dvec3 exposed = scale_ * (balance_ ? *balance_ * radiance : radiance);
    glm::dvec3 signals(0);
    if (kind_ == ToneCurve::Kind::Power) {
        for (int c = 0; c < 3; ++c)
            signals[c] = exposed[c] > 0 ? powerFromLinear(exposed[c]) : 0.0;
        return signals;
    }
    const glm::dvec3 light = displayLight(view_, exposed);
    for (int c = 0; c < 3; ++c)
        signals[c] = srgbFromLinear(light[c]);
    return signals;
}

// --- From signals to whole numbers ---------------------------------------------------------------

/// Fractions of the sequence R2 (Martin Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018), a lattice of a column's and a row's steps: the reciprocals of the plastic
/// number and of its square, times 2^32. Numbers of 32 bits wrap around as fractions do.
double ditherThreshold(const PixelPlace& pixel) {
    const uint32_t fraction = pixel.x * 0xC13FA9A9u + pixel.y * 0x91E10DA5u;
    return (fraction + 0.5) / 4294967296.0;
}

namespace {

template <class Value>
ScreenImage<Value> numbersOf(const FloatImage& radiance, const ToneMapping& tone, bool dithers) {
    constexpr double most = std::numeric_limits<Value>::max();
    const CoveredColors covered(radiance);
    const SignalOfRadiance signalOf(tone);
    const double usual = tone.curve.kind == ToneCurve::Kind::Srgb ? 0.5 : 0; // or rounded down
    const Crop part = radiance.area.rendered();
    ScreenImage<Value> image(radiance.width, radiance.height);
    if (covered.hasAlpha()) image.alpha.resize(size_t(image.width) * image.height);
    tbb::parallel_for(0u, image.height, [&](uint32_t y) {
        for (uint32_t x = 0; x < image.width; ++x) {
            const size_t i = size_t(y) * image.width + x;
            const glm::dvec3 signals = signalOf(covered.at(i));
            const double added = dithers ? ditherThreshold({part.x + x, part.y + y}) : usual;
            for (int c = 0; c < 3; ++c)
                image.pixel(x, y)[c] = Value(most * signals[c] + added);
            if (covered.hasAlpha()) image.alpha[i] = Value(float(most) * covered.alpha(i) + 0.5f);
        }
    });
    return image;
}

} // namespace

template <class Value>
ScreenImage<Value> toneMap(const FloatImage& radiance, const ToneMapping& tone, bool dithers) {
    return numbersOf<Value>(radiance, tone, dithers);
}

template ByteImage toneMap(const FloatImage&, const ToneMapping&, bool);
template WordImage toneMap(const FloatImage&, const ToneMapping&, bool);

} // namespace stromboli
