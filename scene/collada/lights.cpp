#include "scene/collada/lights.hpp"

#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/effects.hpp"
#include "scene/collada/numbers.hpp"
#include "scene/collada/transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stromboli::collada {
namespace {

/// The element that says what the light is; null where nothing does.
const Element* lightKind(Context& context, const Element& light) {
    if (const Element* dialect = findCglLight(context, light)) return dialect;
    const Element* technique = light.FirstChildElement("technique_common");
    if (technique)
        for (const char* known : {"ambient", "directional", "point", "spot"})
            if (const Element* kind = technique->FirstChildElement(known)) return kind;
    context.document.forgive(light,
                             fmt::format("'{}' has no <technique_common> with <ambient>, "
                                         "<directional>, <point> or <spot>",
                                         displayName(light)),
                             kNoLight);
    return nullptr;
}

/// The number, or the nearest one in its range, which is said.
double within(const Document& document, const Element& at, const char* name, double number,
              double least, double most) {
    if (number >= least && number <= most) return number;
    document.replace(at, build::Shortfall::Number,
                     fmt::format("<{}> is {}, expected {} to {}", name, number, least, most));
    return std::clamp(number, least, most);
}

/// Distances in the file are in its own unit, those of the scene in metres: the coefficients are
/// converted so that the light falls off over the same things.
void readAttenuation(Context& context, const Element& at, Light& light) {
    const Document& document = context.document;
    const double meters = context.conventions.applyUnit ? metersPerUnit(document) : 1;
    const auto coefficient = [&](const char* name, double byDefault, double per) {
        const double number = readNumberOr(document, at, name, byDefault);
        return toFloat(document, at, within(document, at, name, number, 0, HUGE_VAL) / per);
    };
    light.constantAttenuation = coefficient("constant_attenuation", 1, 1);
    light.linearAttenuation = coefficient("linear_attenuation", 0, meters);
    light.quadraticAttenuation = coefficient("quadratic_attenuation", 0, meters * meters);
    if (light.constantAttenuation + light.linearAttenuation + light.quadraticAttenuation == 0) {
        document.replace(at, build::Shortfall::Parameter,
                         "one of the attenuation coefficients must be greater than 0");
        light.constantAttenuation = 1;
    }
}

void readCone(Context& context, const Element& at, Light& light) {
    const Document& document = context.document;
    const double angle = within(document, at, "falloff_angle",
                                readNumberOr(document, at, "falloff_angle", 180), 0, 360);
    const double exponent = within(document, at, "falloff_exponent",
                                   readNumberOr(document, at, "falloff_exponent", 0), 0, HUGE_VAL);
    light.falloffAngle = float(glm::radians(angle));
    light.falloffExponent = toFloat(document, at, exponent);
}

} // namespace

void placeLight(Context& context, const Element& element, const glm::dmat4& toWorld) {
    const Element* found = lightKind(context, element);
    if (!found) return;
    const Element& kind = *found;
    Light light;
    light.name = displayName(element);
    light.color = readLightColor(context, context.document.require(kind, "color"));
    if (named(kind, "area")) light.kind = LightKind::Area;
    if (named(kind, "directional")) light.kind = LightKind::Directional;
    if (named(kind, "point")) light.kind = LightKind::Point;
    if (named(kind, "spot")) light.kind = LightKind::Spot;
    if (named(kind, "ambient") || named(kind, "hemisphere")) light.kind = LightKind::Ambient;
    if (light.kind == LightKind::Spot) readCone(context, kind, light);
    const bool fallsOff = light.kind == LightKind::Point || light.kind == LightKind::Spot;
    if (fallsOff && context.conventions.attenuation) readAttenuation(context, kind, light);
    context.builder.placeLight(std::move(light), toWorld);
}

} // namespace stromboli::collada
