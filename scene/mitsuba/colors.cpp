#include "scene/mitsuba/colors.hpp"

#include "scene/mitsuba/spectrum.hpp"

#include <fmt/format.h>

namespace stromboli::mitsuba {
namespace {

glm::dvec3 colorOfSpectrum(const SpectrumValue& spectrum, ColorOf what) {
    if (spectrum.samples.empty())
        return spectrum.everywhere * (what == ColorOf::Light ? kEqualEnergy : glm::dvec3(1));
    if (what == ColorOf::Light) return rgbOfLight(spectrum.samples);
    if (what == ColorOf::Reflectance) return rgbOfReflectance(spectrum.samples);
    // An index is no fraction: what the curves weigh is divided by what they weigh of 1.
    double most = 1;
    for (const auto& [wavelength, value] : spectrum.samples)
        most = std::max(most, value);
    std::vector<std::pair<double, double>> fractions = spectrum.samples;
    for (auto& [wavelength, value] : fractions)
        value /= most;
    return most * rgbOfReflectance(fractions);
}

std::optional<glm::dvec3> colorOfValue(const Plugin& plugin, std::string_view name,
                                       const Value& value, ColorOf what) {
    if (const double* number = std::get_if<double>(&value)) return glm::dvec3(*number);
    if (const int64_t* whole = std::get_if<int64_t>(&value)) return glm::dvec3(double(*whole));
    if (const RgbValue* rgb = std::get_if<RgbValue>(&value)) return rgb->rgb;
    if (const SpectrumValue* spectrum = std::get_if<SpectrumValue>(&value))
        return colorOfSpectrum(*spectrum, what);
    plugin.fail(name,
                fmt::format("is {}, expected a colour: rgb, spectrum or float", typeOf(value)));
}

} // namespace

std::optional<glm::dvec3> colorOf(const Plugin& plugin, std::string_view name, ColorOf what) {
    if (const Value* value = plugin.find(name)) return colorOfValue(plugin, name, *value, what);
    const Plugin* object = plugin.child(name);
    if (!object) return std::nullopt;
    const bool isSpectrum = object->tag == "spectrum";
    if (object->type != "uniform" && object->type != "srgb" && object->type != "rgb") {
        if (isSpectrum)
            object->fail(fmt::format("'{}' is no spectrum that is read, expected uniform, or a "
                                     "value without a type",
                                     object->type));
        return std::nullopt;
    }
    const char* parameter = object->type == "uniform" ? "value" : "color";
    const Value* value = object->find(parameter);
    if (!value) object->fail(fmt::format("has no '{}'", parameter));
    const std::optional<glm::dvec3> color = colorOfValue(*object, parameter, *value, what);
    object->requireAllRead();
    // A uniform spectrum is the same power at every wavelength.
    const bool isEqualEnergy = what == ColorOf::Light && object->type == "uniform" &&
                               !std::holds_alternative<RgbValue>(*value) &&
                               !std::holds_alternative<SpectrumValue>(*value);
    return isEqualEnergy ? *color * kEqualEnergy : color;
}

} // namespace stromboli::mitsuba
