#include "scene/pbrt/colors.hpp"

#include "scene/build/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace stromboli::pbrt {
namespace {

using Samples = std::vector<std::pair<double, double>>;

/// IEC 61966-2-1; columns.
const glm::dmat3 kRgbFromXyz(3.240479, -0.969256, 0.055648, -1.537150, 1.875991, -0.204043,
                             -0.498535, 0.041556, 1.057311);

/// The CIE's chromaticities of standard illuminants for the observer of 1931 (CIE 15).
struct Illuminant {
    std::string_view name;
    double x, y;
};
constexpr Illuminant kIlluminants[] = {
    {"stdillum-A", 0.44757, 0.40745},   {"stdillum-D50", 0.34567, 0.35850},
    {"stdillum-D65", 0.31271, 0.32902}, {"stdillum-F1", 0.31310, 0.33727},
    {"stdillum-F2", 0.37208, 0.37529},  {"stdillum-F3", 0.40910, 0.39430},
    {"stdillum-F4", 0.44018, 0.40329},  {"stdillum-F5", 0.31379, 0.34531},
    {"stdillum-F6", 0.37790, 0.38835},  {"stdillum-F7", 0.31292, 0.32933},
    {"stdillum-F8", 0.34588, 0.35875},  {"stdillum-F9", 0.37417, 0.37281},
    {"stdillum-F10", 0.34609, 0.35986}, {"stdillum-F11", 0.38052, 0.37713},
    {"stdillum-F12", 0.43695, 0.40441}, {"illum-acesD60", 0.32168, 0.33767},
};

/// Indices of glasses at 587.6 nm, as their makers list them.
struct Glass {
    std::string_view name;
    double index;
};
constexpr Glass kGlasses[] = {
    {"glass-BK7", 1.5168},    {"glass-BAF10", 1.67003}, {"glass-FK51A", 1.48656},
    {"glass-LASF9", 1.85025}, {"glass-F5", 1.67270},    {"glass-SF5", 1.67270},
    {"glass-F10", 1.72825},   {"glass-SF10", 1.72825},  {"glass-F11", 1.78472},
    {"glass-SF11", 1.78472},
};

/// Brass, which the common table does not have.
const build::NamedMetal kBrass{"CuZn", {{0.444, 0.527, 1.094}, {3.695, 2.765, 1.829}}};

glm::dvec3 xyzOf(double x, double y) {
    return {x / y, 1, (1 - x - y) / y};
}

/// What metal-NAME-eta or metal-NAME-k stands for.
std::optional<glm::dvec3> metalNamed(std::string_view name) {
    if (!name.starts_with("metal-")) return std::nullopt;
    name.remove_prefix(6);
    const bool isIndex = name.ends_with("-eta");
    if (!isIndex && !name.ends_with("-k")) return std::nullopt;
    name.remove_suffix(isIndex ? 4 : 2);
    const auto part = [&](const build::NamedMetal& metal) {
        return isIndex ? metal.index.eta : metal.index.k;
    };
    if (name == kBrass.name) return part(kBrass);
    for (const build::NamedMetal& metal : build::namedMetals())
        if (metal.name == name) return part(metal);
    return std::nullopt;
}

std::optional<glm::dvec3> colorNamed(std::string_view name) {
    for (const Illuminant& illuminant : kIlluminants)
        if (illuminant.name == name)
            return glm::max(kRgbFromXyz * xyzOf(illuminant.x, illuminant.y), 0.0);
    for (const Glass& glass : kGlasses)
        if (glass.name == name) return glm::dvec3(glass.index);
    return metalNamed(name);
}

/// In the order of wavelengths; of two values at one wavelength the first one counts.
Samples sorted(const std::vector<double>& numbers) {
    Samples samples;
    for (size_t i = 0; i + 1 < numbers.size(); i += 2)
        if (std::isfinite(numbers[i]) && std::isfinite(numbers[i + 1]))
            samples.emplace_back(numbers[i], numbers[i + 1]);
    std::ranges::stable_sort(samples, {}, [](const auto& sample) { return sample.first; });
    const auto rest = std::unique(samples.begin(), samples.end(),
                                  [](const auto& a, const auto& b) { return a.first == b.first; });
    samples.erase(rest, samples.end());
    return samples;
}

/// A file has a wavelength and a value in each line.
Samples samplesOfFile(const Context& context, const Parameters& parameters, const Parameter& p) {
    return sorted(
        context.files.numbers(parameters.placeOf(p), p.words.front(), "wavelengths and values"));
}

/// Values at wavelengths that a parameter states, or a file that it names; nothing for what is no
/// such thing.
std::optional<Samples> samplesOf(const Context& context, const Parameters& parameters,
                                 const Parameter& p) {
    if (p.type != "spectrum") return std::nullopt;
    if (p.numbers.empty() && (p.words.empty() || colorNamed(p.words.front()))) return std::nullopt;
    Samples samples = p.numbers.empty() ? samplesOfFile(context, parameters, p) : sorted(p.numbers);
    if (samples.empty()) return std::nullopt;
    if (context.isV3() || samples.size() == 1) { // it goes on beyond the ends as it is there
        samples.insert(samples.begin(),
                       {std::min(samples.front().first - 1, 300.0), samples.front().second});
        samples.emplace_back(std::max(samples.back().first + 1, 900.0), samples.back().second);
    }
    return samples;
}

glm::dvec3 rgbOf(const Context& context, const Samples& samples, ColorOf what) {
    if (context.isV3()) return build::rgbOfLight(samples);
    if (what == ColorOf::Light) {
        const glm::dvec3 rgb = build::rgbOfLight(samples);
        const double y = luminance(rgb);
        return y > 0 ? rgb / y : glm::dvec3(0);
    }
    if (what == ColorOf::Reflectance) return build::rgbOfReflectance(samples);
    // This is no fraction: what the curves weigh is divided by what they weigh of 1.
    double most = 1;
    for (const auto& [wavelength, value] : samples)
        most = std::max(most, value);
    Samples fractions = samples;
    for (auto& [wavelength, value] : fractions)
        value /= most;
    return most * build::rgbOfReflectance(fractions);
}

std::optional<glm::dvec3> blackbody(const Context& context, const Parameter& p) {
    if (p.numbers.empty() || !(p.numbers[0] > 0 && p.numbers[0] < 1e7)) return std::nullopt;
    if (!context.isV3()) return rgbOf(context, build::blackbody(p.numbers[0]), ColorOf::Light);
    return blackbodyOfPeak(p.numbers[0]) * (p.numbers.size() > 1 ? p.numbers[1] : 1.0);
}

std::optional<glm::dvec3> colorOfParameter(const Context& context, const Parameters& parameters,
                                           const Parameter& p, ColorOf what) {
    const std::vector<double>& n = p.numbers;
    if (p.type == "blackbody") return blackbody(context, p);
    if (const std::optional<Samples> samples = samplesOf(context, parameters, p))
        return rgbOf(context, *samples, what);
    if (p.type == "spectrum") return p.words.empty() ? std::nullopt : colorNamed(p.words.front());
    if (n.size() >= 3) {
        const glm::dvec3 color(n[0], n[1], n[2]);
        return p.type == "xyz" ? kRgbFromXyz * color : color;
    }
    return n.empty() ? std::nullopt : std::optional(glm::dvec3(n[0]));
}

/// The metal whose reflectance at normal incidence is that of the spectra: a channel of the index
/// of refraction is no mean of it, and what a metal looks like is what it reflects.
build::MetalIndex metalOfSamples(const Context& context, const Samples& eta, const Samples& k) {
    build::MetalIndex metal{rgbOf(context, eta, ColorOf::Number),
                            rgbOf(context, k, ColorOf::Number)};
    const auto at = [](const Samples& samples, double l) {
        const auto above =
            std::ranges::lower_bound(samples, l, {}, [](const auto& s) { return s.first; });
        if (above == samples.begin()) return samples.front().second;
        if (above == samples.end()) return samples.back().second;
        const auto below = above - 1;
        const double share = (l - below->first) / (above->first - below->first);
        return std::lerp(below->second, above->second, share);
    };
    Samples reflected;
    for (double l = 360; l <= 830; l += 5) {
        const build::MetalIndex one{glm::dvec3(at(eta, l)), glm::dvec3(at(k, l))};
        reflected.emplace_back(l, std::clamp(facingReflectance(one).x, 0.0, 1.0));
    }
    const glm::dvec3 facing = build::rgbOfReflectance(reflected);
    for (const int c : {0, 1, 2}) {
        const double r = std::min(facing[c], 0.9999), n = std::max(metal.eta[c], 1e-3);
        const double squared = (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r);
        metal.eta[c] = n;
        metal.k[c] = std::sqrt(std::max(squared, 0.0));
    }
    return metal;
}

} // namespace

glm::dvec3 blackbodyOfPeak(double kelvins) {
    Samples samples = build::blackbody(kelvins);
    // By Wien's law the peak is at 2.8977721e-3 m K over the temperature; what it has there is 1.
    const double x = 4.965114231744276;
    const double peak = 2 * std::pow(1.380649e-23 * x, 5) * std::pow(kelvins, 5) /
                        (std::pow(6.62607015e-34, 4) * std::pow(299792458.0, 3)) / std::expm1(x) *
                        1e-9;
    for (auto& [wavelength, value] : samples)
        value /= peak;
    return build::rgbOfLight(samples);
}

double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.212671, 0.715160, 0.072169));
}

std::optional<glm::dvec3> colorOf(const Context& context, const Parameters& parameters,
                                  std::string_view name, ColorOf what) {
    const Parameter* found = parameters.find(name);
    if (!found || found->type == "texture") return std::nullopt;
    std::optional<glm::dvec3> color = colorOfParameter(context, parameters, *found, what);
    for (const int c : {0, 1, 2})
        if (color && !std::isfinite((*color)[c])) color.reset();
    if (!color)
        parameters.replaceParameter(
            name, build::Shortfall::Word,
            fmt::format("is no colour of the type '{}' that is read{}", found->type,
                        found->words.empty() ? "" : ": '" + found->words.front() + "'"));
    return color;
}

double indexOf(const Context& context, const Parameters& parameters, double otherwise) {
    // pbrt-v3 has both names.
    const char* name = context.isV3() && !parameters.has("eta") ? "index" : "eta";
    return indexOf(context, parameters, name, otherwise);
}

double indexOf(const Context& context, const Parameters& parameters, const char* name,
               double otherwise) {
    const Parameter* found = parameters.find(name);
    if (!found) return otherwise;
    const std::optional<glm::dvec3> color = colorOf(context, parameters, name, ColorOf::Number);
    if (found->type == "texture")
        parameters.replaceParameter(name, build::Shortfall::Word,
                                    "is a texture, expected a number");
    if (found->type == "spectrum")
        parameters.replace(build::Shortfall::Model,
                           fmt::format("'{}' is a spectrum, which disperses light", name),
                           "one index for all colours");
    const double index = color ? color->y : otherwise;
    if (index > 0) return index;
    parameters.replaceParameter(name, build::Shortfall::Word, "is 0 or less");
    return otherwise;
}

build::MetalIndex metalOf(const Context& context, const Parameters& parameters,
                          const std::string& eta, const std::string& k) {
    const Parameter *n = parameters.find(eta), *extinction = parameters.find(k);
    if (n && extinction) {
        const std::optional<Samples> a = samplesOf(context, parameters, *n),
                                     b = samplesOf(context, parameters, *extinction);
        if (a && b && !context.isV3()) return metalOfSamples(context, *a, *b);
    }
    build::MetalIndex metal{*metalNamed("metal-Cu-eta"), *metalNamed("metal-Cu-k")};
    if (const auto stated = colorOf(context, parameters, eta, ColorOf::Number))
        metal.eta = glm::max(*stated, 0.0);
    if (const auto stated = colorOf(context, parameters, k, ColorOf::Number))
        metal.k = glm::max(*stated, 0.0);
    return metal;
}

glm::dvec3 facingReflectance(const build::MetalIndex& metal) {
    const glm::dvec3 below = metal.eta - 1.0, above = metal.eta + 1.0, k2 = metal.k * metal.k;
    return (below * below + k2) / (above * above + k2);
}

build::MetalIndex metalOfReflectance(const glm::dvec3& reflectance) {
    const glm::dvec3 r = glm::clamp(reflectance, 0.0, 0.9999);
    return {glm::dvec3(1), 2.0 * glm::sqrt(r) / glm::sqrt(1.0 - r)};
}

std::optional<glm::dmat3> rec709From(std::string_view colorSpace) {
    struct Space {
        std::string_view name;
        double primaries[6], white[2]; ///< x and y of red, green, blue; of white
    };
    static constexpr Space kSpaces[] = {
        {"srgb", {0.64, 0.33, 0.3, 0.6, 0.15, 0.06}, {0.3127, 0.329}},
        {"dci-p3", {0.68, 0.32, 0.265, 0.69, 0.15, 0.06}, {0.3127, 0.329}},
        {"rec2020", {0.708, 0.292, 0.17, 0.797, 0.131, 0.046}, {0.3127, 0.329}},
        {"aces2065-1", {0.7347, 0.2653, 0, 1, 0.0001, -0.077}, {0.32168, 0.33767}},
    };
    for (const Space& space : kSpaces) {
        if (space.name != colorSpace) continue;
        if (space.name == "srgb") return glm::dmat3(1.0);
        glm::dmat3 columns;
        for (const int c : {0, 1, 2}) {
            const double x = space.primaries[2 * c], y = space.primaries[2 * c + 1];
            columns[c] = glm::dvec3(x, y, 1 - x - y);
        }
        const glm::dvec3 white = xyzOf(space.white[0], space.white[1]);
        const glm::dvec3 amounts = glm::inverse(columns) * white;
        for (const int c : {0, 1, 2})
            columns[c] *= amounts[c];
        // White stays white.
        const glm::dvec3 scale = 1.0 / (kRgbFromXyz * columns * glm::dvec3(1));
        glm::dmat3 result = kRgbFromXyz * columns;
        for (const int c : {0, 1, 2})
            result[c] *= scale;
        return result;
    }
    return std::nullopt;
}

} // namespace stromboli::pbrt
