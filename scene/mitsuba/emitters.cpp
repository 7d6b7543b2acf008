#include "scene/mitsuba/emitters.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/environment_map.hpp"
#include "scene/mitsuba/sensors.hpp"
#include "scene/mitsuba/sunsky.hpp"
#include "scene/mitsuba/textures.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>

namespace stromboli::mitsuba {
namespace {

/// The file's lamps shine along z, the builder's along -z.
glm::dmat4 turnedAround(const glm::dmat4& m) {
    return m * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, -1));
}

glm::vec3 lightOf(Context& context, const Plugin& emitter, const char* name) {
    const std::optional<glm::dvec3> color = colorOf(emitter, name, ColorOf::Light);
    if (!color && emitter.child(name))
        emitter.replaceParameter(name, build::Shortfall::Word, "is a texture, expected a colour");
    return context.builder.lightColor(name, color.value_or(glm::dvec3(1)));
}

/// Radiant intensity: falls off with the square of the distance.
void setIntensity(Context& context, const Plugin& emitter, Light& light) {
    light.color = lightOf(context, emitter, "intensity");
    light.constantAttenuation = light.linearAttenuation = 0;
    light.quadraticAttenuation = 1;
}

glm::dmat4 pointLight(Context& context, const Plugin& emitter, Light& light) {
    light.kind = LightKind::Point;
    setIntensity(context, emitter, light);
    const std::optional<glm::dvec3> position = emitter.vector("position");
    if (position && emitter.has("to_world"))
        emitter.replaceParameter("to_world", build::Shortfall::Parameter,
                                 "is stated beside position, expected one of both");
    return position ? glm::translate(glm::dmat4(1.0), *position) : emitter.transform("to_world");
}

void setPicture(const Plugin& emitter, const char* name, const Shade& shade, Light& light) {
    if (!shade.attribute.empty())
        return emitter.replaceParameter(name, build::Shortfall::Picture,
                                        "is a mesh attribute, expected a picture");
    light.picture = shade.texture;
    if (light.picture) light.picture->slot = TextureSlot::Projection;
}

/// The picture's coordinates grow along x and y of the lamp, so much for a tangent of 1.
void setAcross(const Context& context, const glm::dmat4& toWorld, const glm::dvec2& perTangent,
               Light& light) {
    const glm::dmat4 world = context.worldFromFile * toWorld;
    const auto axis = [&](int i) {
        return build::unit(glm::dvec3(world[i])).value_or(glm::dvec3(0));
    };
    light.edgeX = axis(0) * perTangent.x;
    light.edgeY = axis(1) * perTangent.y;
}

/// A perspective camera that is a lamp: on a plane across, its picture is as it is seen.
glm::dmat4 projector(Context& context, const Plugin& emitter, Light& light) {
    light.kind = LightKind::Projector;
    light.isFramed = true;
    light.falloffAngle = std::numbers::pi_v<float>;
    Textures textures(context);
    if (!emitter.has("irradiance") && !emitter.child("irradiance"))
        emitter.replace(build::Shortfall::Word, "has no 'irradiance'");
    const Shade shade = textures.shade(emitter, "irradiance", ColorOf::Light, glm::dvec3(1));
    setPicture(emitter, "irradiance", shade, light);
    const double scale = emitter.number("scale", 0).value_or(1);
    light.color =
        context.builder.lightColor("irradiance", glm::vec3(shade.color * scale * std::numbers::pi));
    light.constantAttenuation = light.linearAttenuation = 0;
    light.quadraticAttenuation = 1;
    double aspect = 1;
    if (light.picture) {
        const glm::uvec2 size = textures.sizeOf(*light.picture);
        aspect = double(size.x) / size.y;
    }
    const double tangent = halfWidthOf(emitter, aspect);
    for (const char* unused : {"fov", "fov_axis", "focal_length"})
        emitter.skip(unused);
    const glm::dmat4 toWorld = emitter.transform("to_world");
    setAcross(context, toWorld, glm::dvec2(-0.5, -0.5 * aspect) / tangent, light);
    return toWorld;
}

glm::dmat4 spotLight(Context& context, const Plugin& emitter, Light& light) {
    light.kind = LightKind::Projector;
    setIntensity(context, emitter, light);
    const double cutoff = emitter.number("cutoff_angle", 0, 90).value_or(20);
    double beam = emitter.number("beam_width", 0, 90).value_or(0.75 * cutoff);
    if (!(beam <= cutoff)) {
        emitter.replaceParameter("beam_width", build::Shortfall::Number,
                                 "is more than cutoff_angle");
        beam = cutoff;
    }
    light.falloffAngle = float(glm::radians(2 * cutoff));
    if (beam < cutoff) light.innerAngle = float(glm::radians(2 * beam));
    if (emitter.has("texture") || emitter.child("texture")) {
        Textures textures(context);
        setPicture(emitter, "texture",
                   textures.shade(emitter, "texture", ColorOf::Light, glm::dvec3(1)), light);
        if (!light.picture)
            emitter.replaceParameter("texture", build::Shortfall::Picture,
                                     "is no picture, expected one");
    }
    const glm::dmat4 toWorld = emitter.transform("to_world");
    const double across = 0.5 / std::tan(glm::radians(cutoff));
    setAcross(context, toWorld, glm::dvec2(across), light);
    return toWorld;
}

glm::dmat4 directionalLight(Context& context, const Plugin& emitter, Light& light) {
    light.kind = LightKind::Directional;
    light.color = lightOf(context, emitter, "irradiance");
    const std::optional<glm::dvec3> stated = emitter.vector("direction");
    if (!stated) return emitter.transform("to_world");
    if (emitter.has("to_world"))
        emitter.replaceParameter("to_world", build::Shortfall::Parameter,
                                 "is stated beside direction, expected one of both");
    const std::optional<glm::dvec3> z = build::unit(*stated);
    if (!z) emitter.fail("direction", "has no length");
    const glm::dvec3 other = std::abs(z->x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, *z));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(*z, x), 0), glm::dvec4(*z, 0),
            glm::dvec4(0, 0, 0, 1)};
}

void setConstant(Context& context, const Plugin& emitter) {
    Environment environment;
    environment.name = "constant";
    environment.radiance = {lightOf(context, emitter, "radiance")};
    emitter.skip("to_world");
    context.builder.setEnvironment(std::move(environment));
}

} // namespace

void placeEmitter(Context& context, const Plugin& emitter) {
    if (isEnvironment(emitter) && context.environment != &emitter) return;
    emitter.skip("sampling_weight");
    emitter.skip("samplingWeight");
    Light light;
    light.name = emitter.displayName();
    const std::string& type = emitter.type;
    if (isEnvironment(emitter)) {
        if (type == "constant")
            setConstant(context, emitter);
        else if (type == "envmap")
            setEnvironmentMap(context, emitter);
        else
            setSunSky(context, emitter);
        return emitter.requireAllRead();
    }
    glm::dmat4 toWorld(1.0);
    if (type == "point")
        toWorld = pointLight(context, emitter, light);
    else if (type == "spot")
        toWorld = spotLight(context, emitter, light);
    else if (type == "projector")
        toWorld = projector(context, emitter, light);
    else if (type == "directional")
        toWorld = directionalLight(context, emitter, light);
    else if (type == "collimated")
        emitter.fail("is a beam without a width, which lights nothing that a path can meet");
    else if (type == "area" || type == "directionalarea")
        emitter.fail("shines on a surface, expected it inside of a shape");
    else
        emitter.fail(fmt::format(
            "'{}' is no emitter that is read, expected point, spot, "
            "projector, directional, constant, envmap, sky, sun, sunsky, or area inside of a "
            "shape",
            type));
    emitter.requireAllRead();
    context.builder.placeLight(std::move(light), context.worldFromFile * turnedAround(toWorld));
}

} // namespace stromboli::mitsuba
