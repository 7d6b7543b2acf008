#include "scene/mitsuba/colors.hpp"

#include "scene/build/spectrum.hpp"
#include "scene/mitsuba/color_text.hpp"
#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {
namespace {

/// A spectrum of equal power at all wavelengths. In Mitsuba 0.x, whose colours are relative to D65,
/// it is white.
glm::dvec3 equalEnergy(const Plugin& plugin, ColorOf what) {
    return what == ColorOf::Light && !plugin.isOld ? build::kEqualEnergy : glm::dvec3(1);
}

glm::dvec3 colorOfSpectrum(const Plugin& plugin, const SpectrumValue& spectrum, ColorOf what) {
    if (spectrum.samples.empty()) return spectrum.everywhere * equalEnergy(plugin, what);
    if (what == ColorOf::Light) return build::rgbOfLight(spectrum.samples);
    if (what == ColorOf::Reflectance) return build::rgbOfReflectance(spectrum.samples);
    // An index is no fraction: what the curves weigh is divided by what they weigh of 1.
    double most = 1;
    for (const auto& [wavelength, value] : spectrum.samples)
        most = std::max(most, value);
    std::vector<std::pair<double, double>> fractions = spectrum.samples;
    for (auto& [wavelength, value] : fractions)
        value /= most;
    return most * build::rgbOfReflectance(fractions);
}

std::optional<glm::dvec3> colorOfValue(const Plugin& plugin, std::string_view name,
                                       const Value& value, ColorOf what) {
    if (const double* number = std::get_if<double>(&value)) return glm::dvec3(*number);
    if (const int64_t* whole = std::get_if<int64_t>(&value)) return glm::dvec3(double(*whole));
    if (const RgbValue* rgb = std::get_if<RgbValue>(&value)) return rgb->rgb;
    if (const glm::dvec3* vector = std::get_if<glm::dvec3>(&value)) return *vector;
    if (const SpectrumValue* spectrum = std::get_if<SpectrumValue>(&value))
        return colorOfSpectrum(plugin, *spectrum, what);
    plugin.replaceParameter(
        name, build::Shortfall::Word,
        fmt::format("is {}, expected a colour: rgb, spectrum or float", typeOf(value)));
    return std::nullopt;
}

std::vector<double> listOf(const Plugin& spectrum, const char* name) {
    return numbersOf(spectrum.place, spectrum.requireText(name));
}

/// Values at wavelengths that are listed, or evenly apart.
SpectrumValue listedSpectrum(const Plugin& plugin) {
    SpectrumValue spectrum;
    const std::vector<double> values = listOf(plugin, "values");
    std::vector<double> wavelengths;
    if (plugin.type == "regular") {
        const double first = plugin.number("wavelength_min").value_or(360);
        const double last = plugin.number("wavelength_max").value_or(830);
        for (size_t i = 0; i < values.size(); ++i)
            wavelengths.push_back(first + (last - first) * double(i) /
                                              double(std::max<size_t>(values.size(), 2) - 1));
    } else {
        wavelengths = listOf(plugin, "wavelengths");
    }
    if (wavelengths.size() != values.size() || values.size() < 2)
        plugin.fail(fmt::format("has {} wavelengths and {} values, expected as many, two or more",
                                wavelengths.size(), values.size()));
    for (size_t i = 0; i < values.size(); ++i)
        spectrum.samples.emplace_back(wavelengths[i], values[i]);
    if (!std::ranges::is_sorted(spectrum.samples))
        plugin.fail("has wavelengths out of their order");
    return spectrum;
}

/// The value of an object that is one colour; nothing where it is none.
std::optional<glm::dvec3> colorOfObject(const Plugin& object, ColorOf what) {
    const std::string& type = object.type;
    if (type == "blackbody") {
        object.skip("wavelength_min");
        object.skip("wavelength_max");
        const double kelvins = object.number("temperature", 1, 1e6).value_or(5000);
        return colorOfSpectrum(object, blackbodyOf(kelvins, object.number("scale").value_or(1)),
                               what);
    }
    if (type == "regular" || type == "irregular")
        return colorOfSpectrum(object, listedSpectrum(object), what);
    if (type == "d65")
        return colorOf(object, "color", what).value_or(glm::dvec3(1)) *
               object.number("scale").value_or(1);
    if (type != "uniform" && type != "srgb" && type != "rgb" && type != "rawconstant")
        return std::nullopt;
    const char* parameter = type == "uniform" || type == "rawconstant" ? "value" : "color";
    const Value* value = object.find(parameter);
    if (!value) object.fail(fmt::format("has no '{}'", parameter));
    const std::optional<glm::dvec3> color = colorOfValue(object, parameter, *value, what);
    // A uniform spectrum is the same power at every wavelength.
    const bool isEverywhere = type == "uniform" && !std::holds_alternative<RgbValue>(*value) &&
                              !std::holds_alternative<SpectrumValue>(*value);
    return color && isEverywhere ? *color * equalEnergy(object, what) : color;
}

} // namespace

std::optional<glm::dvec3> colorOf(const Plugin& plugin, std::string_view name, ColorOf what) {
    if (const Value* value = plugin.find(name)) return colorOfValue(plugin, name, *value, what);
    const Plugin* object = plugin.child(name);
    if (!object) return std::nullopt;
    const std::optional<glm::dvec3> color = colorOfObject(*object, what);
    if (color) {
        object->requireAllRead();
    } else if (object->tag == "spectrum") {
        object->fail(fmt::format("'{}' is no spectrum that is read, expected uniform, d65, "
                                 "blackbody, regular, irregular, rawconstant, or a value without a "
                                 "type",
                                 object->type));
    }
    return color;
}

} // namespace stromboli::mitsuba
