#include "host/reference/surface.hpp"

#include "host/reference/sampling.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {

// --- Points of surfaces --------------------------------------------------------------------------

namespace {

double sumOfMagnitudes(const glm::dvec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// Which side of a plane points or normals are on.
enum class Side { Front, Back, Both };

Side sideOf(const glm::dvec3 (&normals)[3], const glm::dvec3& front) {
    int before = 0, behind = 0;
    for (const glm::dvec3& n : normals) {
        before += glm::dot(n, front) > 0;
        behind += glm::dot(n, front) < 0;
    }
    return before == 3 ? Side::Front : behind == 3 ? Side::Back : Side::Both;
}

void fillTriangle(SurfacePoint& s, const Scene& scene, const Triangle& t, const Hit& hit) {
    const glm::dvec3 v0 = scene.positions[t.corner[0]], v1 = scene.positions[t.corner[1]],
                     v2 = scene.positions[t.corner[2]];
    const double b0 = 1 - hit.b1 - hit.b2;
    s.position = b0 * v0 + hit.b1 * v1 + hit.b2 * v2;
    s.error = errorOnTriangle(v0, v1, v2);
    s.geometric = triangleNormal(v0, v1, v2);
    s.outside = glm::dot(s.geometric, s.wo) >= 0;
    s.shading = s.geometric;
    s.triangle = hit.primitive;
    s.material = s.stated = &scene.materials[t.material];
    if (t.normals[0] == kNoNormals) return;
    SmoothTriangle smooth{{v0, v1, v2}, {}};
    const glm::dvec3 weights(b0, hit.b1, hit.b2);
    glm::dvec3 n(0.0);
    for (int c = 0; c < 3; ++c) {
        smooth.normal[c] = scene.normals[t.normals[c]];
        n += weights[c] * smooth.normal[c];
    }
    // Opposite corner normals can cancel; then only the geometric one is a direction.
    if (glm::dot(n, n) > 0) s.shading = glm::normalize(n);
    s.lift = smooth.height(weights, s.outside ? s.geometric : -s.geometric);
}

void fillSphere(SurfacePoint& s, const Scene& scene, const Sphere& sphere, const Ray& ray,
                const Hit& hit) {
    const glm::dvec3 center = sphere.center;
    s.geometric = glm::normalize(ray.origin + hit.t * ray.direction - center);
    s.position = center + double(sphere.radius) * s.geometric;
    s.error = errorOnSphere(center, sphere.radius);
    s.outside = glm::dot(s.geometric, s.wo) >= 0;
    s.shading = s.geometric;
    s.material = s.stated = &scene.materials[sphere.material];
}

} // namespace

double errorOnTriangle(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2) {
    // Interpolation: 8 roundings of terms no larger than the coordinates. The other 8 are those of
    // the distance to a plane through such points, as intersectTriangle() computes it.
    return 16 * kRoundoff *
           std::max({sumOfMagnitudes(v0), sumOfMagnitudes(v1), sumOfMagnitudes(v2)});
}

double errorOnSphere(const glm::dvec3& center, double radius) {
    // 4 roundings each for the unit vector, its scaling and the sum with the centre; the rest for
    // |f|^2 - r^2 in intersectSphere(), whose sign tells inside from outside.
    return 16 * kRoundoff * (sumOfMagnitudes(center) + radius);
}

glm::dvec3 triangleNormal(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2) {
    return glm::normalize(glm::cross(v1 - v0, v2 - v0));
}

SurfacePoint surfaceAt(const Scene& scene, const Ray& ray, const Hit& hit) {
    SurfacePoint s;
    s.wo = -ray.direction;
    s.primitive = hit.primitive;
    s.b1 = hit.b1, s.b2 = hit.b2;
    const auto triangles = uint32_t(scene.triangles.size());
    if (hit.primitive < triangles)
        fillTriangle(s, scene, scene.triangles[hit.primitive], hit);
    else
        fillSphere(s, scene, scene.spheres[hit.primitive - triangles], ray, hit);
    return s;
}

double SmoothTriangle::height(const glm::dvec3& weights, const glm::dvec3& front) const {
    const Side side = sideOf(normal, front);
    if (side == Side::Both) return 0;
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double diverge = glm::dot(normal[i] - normal[j], corner[i] - corner[j]);
        const double bulge = side == Side::Front ? diverge : -diverge;
        sum += weights[i] * weights[j] * std::max(bulge, 0.0);
    }
    return std::max(sum, 0.0);
}

bool isSeenFromBehind(const SurfacePoint& s) {
    return (glm::dot(s.geometric, s.wo) < 0) != (glm::dot(s.geometric, s.shading) < 0);
}

void faceForward(SurfacePoint& s, const ShadingConventions& conventions) {
    s.isFromBehind = isSeenFromBehind(s);
    if (!conventions.facesForward) {
        s.lift = 0;
        s.unmapped = s.shading;
        return;
    }
    if (!conventions.offsetsTerminator) s.lift = 0;
    if (!s.outside) s.geometric = -s.geometric;
    if (glm::dot(s.shading, s.geometric) < 0) s.shading = -s.shading;
    if (glm::dot(s.shading, s.wo) <= 0) s.shading = s.geometric;
    s.unmapped = s.shading;
}

glm::dvec3 moveOff(const glm::dvec3& position, double error, const glm::dvec3& n,
                   const glm::dvec3& direction) {
    return position + (glm::dot(n, direction) < 0 ? -error : error) * n;
}

glm::dvec3 litPoint(const SurfacePoint& s) {
    return s.position + s.lift * s.geometric;
}

bool isReflected(const SurfacePoint& s, const glm::dvec3& w) {
    return s.lift > 0 || glm::dot(s.geometric, w) > 0;
}

Ray reflectedRay(const SurfacePoint& s, const glm::dvec3& direction) {
    // The side of a lifted point is known; a direction may be below the plane all the same.
    const glm::dvec3& towards = s.lift > 0 ? s.geometric : direction;
    return {moveOff(litPoint(s), s.error, s.geometric, towards), direction};
}

Ray transmittedRay(const SurfacePoint& s, const glm::dvec3& direction) {
    return {moveOff(s.position, s.error, s.geometric, direction), direction};
}

uint32_t startOfReflected(const SurfacePoint& s) {
    return s.lift > 0 ? kNoPrimitive : s.triangle;
}

glm::dvec3 emission(const SurfacePoint& s) {
    const bool lit = s.material->emitsBothSides || s.outside;
    return lit ? glm::dvec3(s.material->emission) : glm::dvec3(0.0);
}

} // namespace stromboli::reference
