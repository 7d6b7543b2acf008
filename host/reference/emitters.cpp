// Samples of single emitters.
#include "host/reference/lights.hpp"

#include "host/core/color.hpp"
#include "scene/model/mean_emission.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace stromboli::reference {

namespace {

/// A point chosen uniformly on an emitter's area.
struct EmitterPoint {
    glm::dvec3 position;
    double error;      ///< distance to stop before the emitter
    glm::dvec3 normal; ///< unit, of the side that always emits
    uint32_t primitive;
    glm::dvec3 emission; ///< radiance
};

LightSample toEmitterPoint(const EmitterPoint& p, const Material& material, double area,
                           const glm::dvec3& from) {
    LightSample sample;
    const glm::dvec3 to = p.position - from;
    const double distance2 = glm::dot(to, to);
    if (distance2 == 0) return sample;
    sample.direction = to / std::sqrt(distance2);
    sample.infinite = false;
    sample.target = moveOff(p.position, p.error, p.normal, -sample.direction);
    sample.primitive = p.primitive;
    const double cosine = -glm::dot(sample.direction, p.normal);
    if (cosine > 0 || material.emitsBothSides)
        sample.value = p.emission * (area * std::abs(cosine) / distance2);
    return sample;
}

} // namespace

EmitterTriangle::EmitterTriangle(const Scene& s, uint32_t i) : index(i), scene(&s) {
    const Triangle& t = s.triangles[i];
    v0 = s.positions[t.corner[0]];
    v1 = s.positions[t.corner[1]];
    v2 = s.positions[t.corner[2]];
    area = 0.5 * glm::length(glm::cross(v1 - v0, v2 - v0));
}

glm::dvec3 EmitterTriangle::emissionAt(const glm::dvec3& point) const {
    const Material& m = scene->materials[scene->triangles[index].material];
    if (m.textures.empty() && m.alphaMode == AlphaMode::Opaque) return m.emission;
    const glm::dvec3 n = glm::cross(v1 - v0, v2 - v0);
    const double n2 = glm::dot(n, n);
    const double b1 = glm::dot(glm::cross(point - v0, v2 - v0), n) / n2;
    const double b2 = glm::dot(glm::cross(v1 - v0, point - v0), n) / n2;
    const PointAttributes at = attributesAt(*scene, index, b1, b2);
    return stromboli::emissionAt(*scene, m, at) * opacityAt(*scene, m, at);
}

namespace {

/// A triangle as seen: unit directions of the corners. Nothing where the point is one of them.
std::optional<SphericalTriangle> asSeen(const EmitterTriangle& t, const glm::dvec3& from) {
    const glm::dvec3 a = t.v0 - from, b = t.v1 - from, c = t.v2 - from;
    if (a == glm::dvec3(0.0) || b == glm::dvec3(0.0) || c == glm::dvec3(0.0)) return std::nullopt;
    return SphericalTriangle(glm::normalize(a), glm::normalize(b), glm::normalize(c));
}

} // namespace

double solidAngle(const EmitterTriangle& t, const glm::dvec3& from) {
    const auto seen = asSeen(t, from);
    return seen ? seen->solidAngle() : 0;
}

LightSample sampleTriangle(const EmitterTriangle& t, double probability, const Material& material,
                           const SurfacePoint& surface, RandomStream& random) {
    const double u = random.next(), v = random.next();
    const glm::dvec3 n = triangleNormal(t.v0, t.v1, t.v2), from = litPoint(surface);
    const double error = errorOnTriangle(t.v0, t.v1, t.v2), z = glm::dot(t.v0 - from, n);
    if (std::abs(z) <= error + surface.error) return {};
    const auto seen = asSeen(t, from);
    if (!seen || seen->solidAngle() < SphericalTriangle::kSmallest) { // uniform on the area
        const glm::dvec2 b = uniformTriangle(u, v);
        const glm::dvec3 at = (1 - b.x - b.y) * t.v0 + b.x * t.v1 + b.y * t.v2;
        const EmitterPoint point{at, error, n, t.index, t.emissionAt(at)};
        return toEmitterPoint(point, material, t.area / probability, from);
    }
    LightSample sample;
    sample.direction = glm::normalize(seen->sample(u, v));
    sample.infinite = false;
    sample.primitive = t.index;
    const glm::dvec3 point = from + z / glm::dot(sample.direction, n) * sample.direction;
    sample.target = moveOff(point, error, n, -sample.direction);
    if (z < 0 || material.emitsBothSides)
        sample.value = t.emissionAt(point) * (seen->solidAngle() / probability);
    return sample;
}

LightSample sampleSphere(const Scene& scene, const Emitter& emitter, const SurfacePoint& surface,
                         RandomStream& random) {
    const double u = random.next(), v = random.next();
    const Sphere& sphere = scene.spheres[emitter.sphere];
    const Material& material = scene.materials[emitter.material];
    const auto primitive = uint32_t(scene.triangles.size()) + emitter.sphere;
    const glm::dvec3 center = sphere.center;
    const double radius = sphere.radius, error = errorOnSphere(center, radius);
    const glm::dvec3 emission =
        stromboli::emissionAt(scene, material, {}) * opacityAt(scene, material, {});
    const glm::dvec3 from = litPoint(surface), toCenter = center - from;
    const double distance2 = glm::dot(toCenter, toCenter), sine2 = radius * radius / distance2;
    const bool inside = surface.primitive == primitive ? !surface.outside : !(sine2 < 1);
    if (inside) {
        const glm::dvec3 n = uniformSphere(u, v);
        return toEmitterPoint({center + radius * n, error, n, primitive, emission}, material,
                              emitter.area, from);
    }
    if (surface.primitive == primitive) return {}; // all of the sphere is below its own horizon

    const double oneMinusCosMax = sine2 / (1 + std::sqrt(1 - sine2));
    const double distance = std::sqrt(distance2);
    const Frame cone(toCenter / distance);
    const glm::dvec3 w = uniformCone(u, v, oneMinusCosMax);
    const double across2 = distance2 * (w.x * w.x + w.y * w.y);
    const double t = distance * w.z - std::sqrt(std::max(radius * radius - across2, 0.0));
    LightSample sample;
    sample.direction = cone.toWorld(w);
    const glm::dvec3 n = glm::normalize(from + t * sample.direction - center);
    sample.target = center + (radius + error) * n;
    sample.infinite = false;
    sample.primitive = primitive;
    sample.value = emission * (2 * kPi * oneMinusCosMax);
    return sample;
}

LightSample sampleRectangle(const Light& light, const glm::dvec3& from,
                            const ShadingConventions& conventions, RandomStream& random) {
    const double u = random.next(), v = random.next();
    const glm::dvec3 center = light.position, x = light.edgeX, y = light.edgeY;
    const glm::dvec3 n = glm::normalize(glm::dvec3(light.direction));
    const glm::dvec3 point = center + (u - 0.5) * x + (v - 0.5) * y;
    const glm::dvec3 to = point - from;
    LightSample sample;
    if (!(glm::dot(to, n) < 0)) return sample;
    const double distance = glm::length(to);
    sample.direction = to / distance;
    sample.infinite = false;
    // The mesh that stands for the light lies in its plane, but both were rounded to float.
    const double error = 0x1p29 * errorOnTriangle(center, center + x, center + y);
    sample.target = moveOff(point, error, n, -to);
    const double falloff = conventions.inverseSquareFalloff ? distance * distance : distance;
    sample.value = glm::dvec3(light.color) *
                   (glm::length(glm::cross(x, y)) * -glm::dot(sample.direction, n) / falloff);
    return sample;
}

} // namespace stromboli::reference
