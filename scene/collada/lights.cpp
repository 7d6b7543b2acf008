#include "scene/collada/lights.hpp"

#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/effects.hpp"
#include "scene/collada/numbers.hpp"
#include "scene/collada/transforms.hpp"
#include "scene/collada/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stromboli::collada {
namespace {

/// The element that says what the light is.
const Element& lightKind(Context& context, const Element& light) {
    if (const Element* dialect = findCglLight(context, light)) return *dialect;
    const Element& technique = context.document.require(light, "technique_common");
    for (const char* known : {"ambient", "directional", "point", "spot"})
        if (const Element* kind = technique.FirstChildElement(known)) return *kind;
    context.document.fail(technique, "has none of <ambient>, <directional>, <point>, <spot>");
}

/// Distances in the file are in its own unit, those of the scene in metres: the coefficients are
/// converted so that the light falls off over the same things.
void readAttenuation(Context& context, const Element& at, Light& light) {
    const Document& document = context.document;
    if (context.options.cs184) return; // no falloff
    const double meters = metersPerUnit(document);
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

/// Where and how the light stands in the world; false if the matrix leaves it no place.
bool placeInWorld(const glm::dmat4& toWorld, bool cs184, Light& light) {
    const glm::dvec3 position = toWorld[3], ahead = -glm::dvec3(toWorld[2]);
    if (light.kind == LightKind::Ambient) return true;
    if (!inRange(position)) return false;
    light.position = position;
    if (light.kind == LightKind::Point) return true;

    // The CS184 renderer transforms (0, 0, -1) as a point, which includes the translation, and
    // takes the result as the direction to the light.
    const bool asPoint = cs184 && light.kind == LightKind::Directional;
    const std::optional<glm::dvec3> direction = unit(asPoint ? -(position + ahead) : ahead);
    if (!direction) return false;
    light.direction = *direction;
    if (light.kind != LightKind::Area) return true;

    const glm::dvec3 x = -glm::dvec3(toWorld[0]), y = toWorld[1];
    if (!inRange(x) || !inRange(y)) return false;
    light.edgeX = x, light.edgeY = y;
    // A sheared node tilts its axis against the rectangle; light leaves at right angles to it.
    const std::optional<glm::dvec3> normal = unit(glm::cross(x, y));
    if (!normal) return false;
    if (!cs184) light.direction = glm::dot(*normal, *direction) < 0 ? -*normal : *normal;
    return true;
}

} // namespace

void placeLight(Context& context, const Element& element, const glm::dmat4& toWorld) {
    const Element& kind = lightKind(context, element);
    Light light;
    light.name = displayName(element);
    light.color = readLightColor(context, context.document.require(kind, "color"));
    if (named(kind, "area")) light.kind = LightKind::Area;
    if (named(kind, "directional")) light.kind = LightKind::Directional;
    if (named(kind, "point")) light.kind = LightKind::Point;
    if (named(kind, "spot")) light.kind = LightKind::Spot;
    if (named(kind, "ambient") || named(kind, "hemisphere")) {
        light.kind = LightKind::Ambient;
        light.upperHemisphereOnly = context.options.cs184;
    }
    if (light.kind == LightKind::Spot) readCone(context, kind, light);
    if (light.kind == LightKind::Spot && context.options.cs184) {
        context.report.ignore("<spot> light", "gives no light in the CS184 renderer");
        return;
    }
    if (light.kind == LightKind::Point || light.kind == LightKind::Spot)
        readAttenuation(context, kind, light);
    if (placeInWorld(toWorld, context.options.cs184, light)) {
        context.scene.lights.push_back(light);
    } else {
        context.report.warn(fmt::format("light '{}' is left out: its node's transformation gives "
                                        "it no place, direction or area within 2^60",
                                        light.name));
    }
}

} // namespace stromboli::collada
