#include "scene/mitsuba/color_text.hpp"

#include "scene/build/spectrum.hpp"
#include "scene/mitsuba/words.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace stromboli::mitsuba {
namespace {

/// In the order of wavelengths; of two values at one wavelength the first one counts.
SpectrumValue sorted(const build::FilePlace& where, SpectrumValue spectrum) {
    auto& samples = spectrum.samples;
    if (samples.size() < 2)
        where.fail(fmt::format("has {} wavelengths, expected two or more", samples.size()));
    std::ranges::stable_sort(samples, {}, [](const auto& sample) { return sample.first; });
    // Clang 14 does not compile std::ranges::unique of this library.
    const auto rest = std::unique(samples.begin(), samples.end(),
                                  [](const auto& a, const auto& b) { return a.first == b.first; });
    samples.erase(rest, samples.end());
    return spectrum;
}

} // namespace

RgbValue rgbOf(const build::FilePlace& where, std::string_view text) {
    return {vectorOf(where, text)};
}

RgbValue hexOf(const build::FilePlace& where, std::string_view text) {
    uint32_t bits = 0;
    const char* end = text.data() + text.size();
    const char* first = text.data() + std::min<size_t>(text.size(), 1);
    const auto [rest, error] = std::from_chars(first, end, bits, 16);
    if (error != std::errc() || rest != end || text.size() != 7)
        where.fail(fmt::format("is '{}', expected #rrggbb", text.substr(0, 40)));
    return {glm::dvec3(bits >> 16, bits >> 8 & 0xFF, bits & 0xFF) / 255.0};
}

RgbValue srgbOf(const build::FilePlace& where, std::string_view text) {
    RgbValue color;
    if (text.starts_with('#'))
        color = hexOf(where, text);
    else
        color.rgb = vectorOf(where, text);
    for (const int channel : {0, 1, 2}) {
        if (!(color.rgb[channel] >= 0 && color.rgb[channel] <= 1))
            where.fail(fmt::format("has the channel {}, expected 0 to 1", color.rgb[channel]));
        color.rgb[channel] = srgbToLinear(color.rgb[channel]);
    }
    return color;
}

Value spectrumOf(const build::FilePlace& where, std::string_view text) {
    SpectrumValue spectrum;
    const std::vector<std::string_view> words = wordsOf(text);
    if (text.find(':') == std::string_view::npos) {
        if (words.size() == 3) return rgbOf(where, text);
        if (words.size() < 2) {
            spectrum.everywhere = numberOf(where, text);
            return spectrum;
        }
        // Means of as many parts of what Mitsuba 0.x sees, for programs built with so many.
        constexpr double kFirst = 360, kLast = 830;
        const double width = (kLast - kFirst) / double(words.size());
        for (size_t i = 0; i < words.size(); ++i)
            spectrum.samples.emplace_back(kFirst + width * (double(i) + 0.5),
                                          numberOf(where, words[i]));
        const double first = spectrum.samples.front().second;
        const double last = spectrum.samples.back().second;
        spectrum.samples.emplace(spectrum.samples.begin(), kFirst, first);
        spectrum.samples.emplace_back(kLast, last);
        return spectrum;
    }
    for (const std::string_view word : words) {
        const size_t colon = word.find(':');
        if (colon == std::string_view::npos)
            where.fail(fmt::format("'{}' is no pair wavelength:value", word.substr(0, 40)));
        spectrum.samples.emplace_back(numberOf(where, word.substr(0, colon)),
                                      numberOf(where, word.substr(colon + 1)));
    }
    return sorted(where, std::move(spectrum));
}

SpectrumValue spectrumOfFile(const build::FilePlace& where, std::string_view text) {
    SpectrumValue spectrum;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        const std::vector<std::string_view> words = wordsOf(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (words.empty() || words[0].starts_with('#')) continue;
        if (words.size() < 2)
            where.fail(fmt::format("names a file with the line '{}', expected a wavelength and a "
                                   "value in each",
                                   words[0].substr(0, 40)));
        spectrum.samples.emplace_back(numberOf(where, words[0]), numberOf(where, words[1]));
    }
    return sorted(where, std::move(spectrum));
}

SpectrumValue blackbodyOf(const build::FilePlace& where, std::string_view temperature,
                          std::string_view scale) {
    while (!temperature.empty() && (temperature.back() == 'K' || temperature.back() == ' '))
        temperature.remove_suffix(1);
    const double kelvins = numberOf(where, temperature);
    if (!(kelvins > 0)) where.fail(fmt::format("has the temperature {}, expected more", kelvins));
    return blackbodyOf(kelvins, numberOf(where, scale));
}

SpectrumValue blackbodyOf(double temperature, double scale) {
    SpectrumValue spectrum;
    spectrum.samples = build::blackbody(temperature);
    for (auto& [wavelength, value] : spectrum.samples)
        value *= scale;
    return spectrum;
}

} // namespace stromboli::mitsuba
