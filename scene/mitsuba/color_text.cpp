#include "scene/mitsuba/color_text.hpp"

#include "scene/mitsuba/words.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <charconv>

namespace stromboli::mitsuba {

RgbValue rgbOf(const build::FilePlace& where, std::string_view text) {
    if (text.find('#') != std::string_view::npos)
        where.fail(fmt::format("is '{}', expected one number or three; <srgb> takes #rrggbb",
                               text.substr(0, 40)));
    return {vectorOf(where, text)};
}

RgbValue srgbOf(const build::FilePlace& where, std::string_view text) {
    RgbValue color;
    if (text.starts_with('#')) {
        uint32_t bits = 0;
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + 1, end, bits, 16);
        if (error != std::errc() || rest != end || text.size() != 7)
            where.fail(fmt::format("is '{}', expected #rrggbb", text.substr(0, 40)));
        color.rgb = glm::dvec3(bits >> 16, bits >> 8 & 0xFF, bits & 0xFF) / 255.0;
    } else {
        color.rgb = vectorOf(where, text);
    }
    for (const int channel : {0, 1, 2}) {
        if (!(color.rgb[channel] >= 0 && color.rgb[channel] <= 1))
            where.fail(fmt::format("has the channel {}, expected 0 to 1", color.rgb[channel]));
        color.rgb[channel] = srgbToLinear(color.rgb[channel]);
    }
    return color;
}

SpectrumValue spectrumOf(const build::FilePlace& where, std::string_view text) {
    SpectrumValue spectrum;
    if (text.find(':') == std::string_view::npos) {
        spectrum.everywhere = numberOf(where, text);
        return spectrum;
    }
    for (const std::string_view word : wordsOf(text)) {
        const size_t colon = word.find(':');
        if (colon == std::string_view::npos)
            where.fail(fmt::format("'{}' is no pair wavelength:value", word.substr(0, 40)));
        const double wavelength = numberOf(where, word.substr(0, colon));
        if (!spectrum.samples.empty() && !(wavelength > spectrum.samples.back().first))
            where.fail(fmt::format("has the wavelength {} after {}, expected more", wavelength,
                                   spectrum.samples.back().first));
        spectrum.samples.emplace_back(wavelength, numberOf(where, word.substr(colon + 1)));
    }
    if (spectrum.samples.size() < 2) where.fail("has one wavelength, expected two or more");
    return spectrum;
}

} // namespace stromboli::mitsuba
