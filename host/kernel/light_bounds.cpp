#include "host/kernel/light_bounds.hpp"

#include "host/core/color.hpp"

#include <glm/gtc/constants.hpp>

#include <cmath>
#include <initializer_list>

namespace stromboli {
namespace {

void encloses(LightBounds& bounds, std::initializer_list<glm::dvec3> points) {
    bounds.lo = glm::dvec3(1e300);
    bounds.hi = glm::dvec3(-1e300);
    for (const glm::dvec3& p : points) {
        bounds.lo = glm::min(bounds.lo, p);
        bounds.hi = glm::max(bounds.hi, p);
    }
}

/// A planar light with this normal, whose length is the light's area times a factor.
LightBounds planar(const Material& material, const glm::dvec3& emission, const glm::dvec3& normal,
                   double area) {
    LightBounds bounds;
    const double length = glm::length(normal);
    if (length > 0) {
        bounds.axis = normal / length;
        bounds.cosSpread = 1;
    }
    bounds.bothSides = material.emitsBothSides;
    bounds.power = luminance(emission) * area;
    return bounds;
}

/// A light with attenuation c + l d + q d^2 at distance d. It counts as near where the last term is
/// the larger one at the scene's size; its irradiance is then at most color / q over the squared
/// distance, and no more than color / c, which is what a sphere of radius sqrt(c / q) makes of it.
void setFalloff(LightBounds& bounds, const Light& light, double sceneRadius) {
    const double c = light.constantAttenuation, l = light.linearAttenuation,
                 q = light.quadraticAttenuation;
    const double flat = c + l * sceneRadius, steep = q * sceneRadius * sceneRadius;
    if (steep >= flat && q > 0) {
        bounds.group = gpu::LIGHT_GROUP_NEAR;
        bounds.power = luminance(light.color) / q;
        bounds.reach = std::sqrt(c / q);
    } else {
        bounds.group = gpu::LIGHT_GROUP_UNATTENUATED;
        bounds.power = luminance(light.color) / (flat + steep);
    }
}

} // namespace

LightBounds boundsOfTriangle(const Scene& scene, uint32_t index, const MeanEmission& means) {
    const Triangle& t = scene.triangles[index];
    const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                     c = scene.positions[t.corner[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    LightBounds bounds = planar(scene.materials[t.material], means.ofTriangle(index), normal,
                                0.5 * glm::length(normal));
    encloses(bounds, {a, b, c});
    return bounds;
}

LightBounds boundsOfEmitter(const Scene& scene, const Emitter& e, const MeanEmission& means) {
    const Material& material = scene.materials[e.material];
    if (e.kind == EmitterKind::Quad) {
        const glm::dvec3 a(e.edgeA), b(e.edgeB), corner(e.corner);
        const glm::dvec3 normal = glm::cross(a, b);
        LightBounds bounds = planar(material, material.emission, normal, glm::length(normal));
        encloses(bounds, {corner, corner + a, corner + b, corner + a + b});
        return bounds;
    }
    const Sphere& sphere = scene.spheres[e.sphere];
    const double radius = sphere.radius;
    LightBounds bounds;
    bounds.lo = bounds.hi = glm::dvec3(sphere.center);
    bounds.reach = radius;
    bounds.power = luminance(means.ofSphere(e.sphere)) * glm::pi<double>() * radius * radius;
    return bounds;
}

LightBounds boundsOfEnvironment(double luminance) {
    LightBounds bounds;
    bounds.group = gpu::LIGHT_GROUP_INFINITE;
    bounds.axis = {0, -1, 0};
    bounds.cosSpread = -1;
    // A surface that may face anywhere sees a quarter of it: the mean of its cosine.
    bounds.power = luminance / 4;
    return bounds;
}

LightBounds boundsOfLight(const Light& light, double sceneRadius) {
    LightBounds bounds;
    bounds.axis = glm::normalize(glm::dvec3(light.direction));
    switch (light.kind) {
    case LightKind::Directional:
        bounds.group = gpu::LIGHT_GROUP_INFINITE;
        bounds.cosSpread = 1;
        bounds.power = luminance(light.color);
        break;
    case LightKind::Ambient:
        bounds.group = gpu::LIGHT_GROUP_INFINITE;
        bounds.axis = {0, -1, 0};
        bounds.cosSpread = light.upperHemisphereOnly ? 0 : -1;
        bounds.power = luminance(light.color) * glm::pi<double>();
        break;
    case LightKind::Point:
    case LightKind::Spot:
    case LightKind::Projector:
        bounds.lo = bounds.hi = glm::dvec3(light.position);
        setFalloff(bounds, light, sceneRadius);
        if (light.kind == LightKind::Point) break;
        bounds.cosSpread = std::cos(0.5 * double(light.falloffAngle));
        bounds.sharp = true;
        break;
    case LightKind::Area:
        break;
    }
    return bounds;
}

} // namespace stromboli
