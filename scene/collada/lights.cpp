#include "scene/collada/lights.hpp"

#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/effects.hpp"
#include "scene/collada/numbers.hpp"
#include "scene/collada/transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Distances in the file are in its own unit, those of the scene in metres: the coefficients are
/// converted so that the light falls off over the same things.
void readAttenuation(Context& context, const Element& at, Light& light) {
    const Document& document = context.document;
    const double meters = context.conventions.applyUnit ? metersPerUnit(document) : 1;
    const double constant = readNumberOr(document, at, "constant_attenuation", 1);
    const double linear = readNumberOr(document, at, "linear_attenuation", 0) / meters;
    const double quadratic =
        readNumberOr(document, at, "quadratic_attenuation", 0) / (meters * meters);
    if (!(std::min({constant, linear, quadratic}) >= 0))
        document.fail(at, "attenuation must not be negative");
    light.constantAttenuation = toFloat(document, at, constant);
    light.linearAttenuation = toFloat(document, at, linear);
    light.quadraticAttenuation = toFloat(document, at, quadratic);
    if (light.constantAttenuation + light.linearAttenuation + light.quadraticAttenuation == 0)
        document.fail(at, "one of the attenuation coefficients must be greater than 0");
}

void readCone(Context& context, const Element& at, Light& light) {
    const Document& document = context.document;
    const double angle = readNumberOr(document, at, "falloff_angle", 180);
    if (!(angle >= 0 && angle <= 360))
        document.fail(at, fmt::format("<falloff_angle> is {}, expected 0 to 360 degrees", angle));
    const double exponent = readNumberOr(document, at, "falloff_exponent", 0);
    if (!(exponent >= 0)) document.fail(at, "<falloff_exponent> must not be negative");
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
