#include "scene/gltf/lights.hpp"

#include <fmt/format.h>

#include <limits>
#include <numbers>

namespace stromboli::gltf {
namespace {

/// Between the cones the format's own formula: the square of a ramp of the cosine.
void readCones(const Element& at, Light& light) {
    constexpr double quarter = std::numbers::pi / 4;
    const std::optional<Element> spot = at.child("spot");
    if (!spot) {
        at.forgive(build::Shortfall::Word, "spot", "is not there");
        light.falloffAngle = float(2 * quarter);
        return;
    }
    const double outer = spot->number("outerConeAngle", quarter, 0, 2 * quarter);
    const double inner = spot->number("innerConeAngle", 0, 0, 2 * quarter);
    if (outer == 0) spot->fail("outerConeAngle", "is 0, expected more");
    light.falloffAngle = float(2 * outer);
    // The format wants the inner cone to be the narrower one; without a ramp the edge is sharp.
    if (float(2 * inner) < light.falloffAngle) light.innerAngle = float(2 * inner);
}

} // namespace

void placeLight(Context& context, const Element& at, const std::string& name,
                const glm::dmat4& toWorld) {
    Light light;
    light.name = name;
    const double intensity =
        at.number("intensity", 1, 0, double(std::numeric_limits<float>::max()));
    light.color = context.builder.lightColor(at.path() + ".color",
                                             intensity * at.vector("color", glm::dvec3(1)));
    const std::string type = at.text("type");
    if (type == "directional") {
        light.kind = LightKind::Directional;
    } else if (type == "point" || type == "spot") {
        light.kind = type == "point" ? LightKind::Point : LightKind::Spot;
        if (context.builder.conventions().attenuation) {
            light.constantAttenuation = 0;
            light.quadraticAttenuation = 1;
        }
        if (type == "spot") readCones(at, light);
        if (at.has("range"))
            context.report().ignore("ranges of lights", "light does not end at a distance");
    } else {
        at.fail("type", fmt::format("is '{}', expected directional, point or spot", type));
    }
    context.builder.placeLight(std::move(light), toWorld);
}

} // namespace stromboli::gltf
