#include "host/kernel/light_kinds.hpp"

#include "host/core/color.hpp"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace stromboli {
namespace {

/// A light with attenuation c + l d + q d^2 at distance d. It counts as near where the last term is
/// the larger one at the scene's size; its irradiance is then at most color / q over the squared
/// distance, and no more than color / c, which is what a sphere of radius sqrt(c / q) makes of it.
void setFalloff(LightBounds& bounds, const Light& light, double sceneRadius) {
    const double c = light.constantAttenuation, l = light.linearAttenuation,
                 q = light.quadraticAttenuation;
    const double flat = c + l * sceneRadius, steep = q * sceneRadius * sceneRadius;
    bounds.lo = bounds.hi = glm::dvec3(light.position);
    if (steep >= flat && q > 0) {
        bounds.group = gpu::LIGHT_GROUP_NEAR;
        bounds.power = luminance(light.color) / q;
        bounds.reach = std::sqrt(c / q);
    } else {
        bounds.group = gpu::LIGHT_GROUP_UNATTENUATED;
        bounds.power = luminance(light.color) / (flat + steep);
    }
}

void setInfinite(LightBounds& bounds, const Light& light) {
    bounds.group = gpu::LIGHT_GROUP_INFINITE;
    bounds.cosSpread = 1;
    bounds.power = luminance(light.color);
}

void setCone(LightBounds& bounds, const Light& light) {
    bounds.cosSpread = std::cos(0.5 * double(light.falloffAngle));
    bounds.sharp = true;
}

/// An area light of the file. The kernel's normal is edgeA x edgeB: the edges are swapped
/// where the light faces the other way.
gpu::QuadLight rectangle(const Light& l) {
    const bool swap = glm::dot(glm::cross(l.edgeX, l.edgeY), l.direction) < 0;
    const glm::vec3 a = swap ? l.edgeY : l.edgeX, b = swap ? l.edgeX : l.edgeY;
    return quadLight(l.position - 0.5f * a - 0.5f * b, a, b);
}

gpu::PointLight pointLight(const Light& l) {
    gpu::PointLight p{};
    p.position = l.position;
    p.axis = l.direction;
    p.attenuation = {l.constantAttenuation, l.linearAttenuation, l.quadraticAttenuation};
    p.cosCutoff = std::cos(0.5f * l.falloffAngle);
    p.falloffExponent = l.falloffExponent;
    if (l.innerAngle) {
        const double inner = std::cos(0.5 * double(*l.innerAngle));
        p.softness = float(1 / (inner - std::cos(0.5 * double(l.falloffAngle))));
    }
    return p;
}

gpu::ProjectorLight projectorLight(const Light& l, uint32_t picture) {
    gpu::ProjectorLight p{};
    p.position = l.position;
    p.cosCutoff = std::cos(0.5f * l.falloffAngle);
    p.acrossU = l.edgeX;
    p.acrossV = l.edgeY;
    if (l.innerAngle) p.softness = 2 / (l.falloffAngle - *l.innerAngle);
    p.picture = picture;
    return p;
}

uint32_t projectorFlags(const Light& l) {
    const bool isMirrored = glm::dot(glm::cross(l.edgeX, l.edgeY), l.direction) < 0;
    return (isMirrored ? gpu::LIGHT_IS_MIRRORED : 0) | (l.isFramed ? gpu::LIGHT_IS_FRAMED : 0);
}

} // namespace

gpu::QuadLight quadLight(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
    gpu::QuadLight q{};
    q.corner = corner;
    q.edgeA = a;
    q.edgeB = b;
    q.area = float(glm::length(glm::cross(glm::dvec3(a), glm::dvec3(b))));
    return q;
}

PackedLight packLight(const Light& l, double sceneRadius, uint32_t picture) {
    PackedLight packed;
    LightBounds& bounds = packed.bounds;
    bounds.axis = glm::normalize(glm::dvec3(l.direction));
    using namespace gpu;
#define PACK_LIGHT(kind_, name, flags, parameters_, bounds_)                                       \
    case LightKind::kind_:                                                                         \
        packed.kindAndFlags = LIGHT_##name | (flags);                                              \
        appendRows(packed.parameters, parameters_);                                                \
        bounds_;                                                                                   \
        break;
    switch (l.kind) {
        DELTA_LIGHTS(PACK_LIGHT)
    case LightKind::Ambient:
        packed.kindAndFlags = LIGHT_AMBIENT;
        bounds.group = LIGHT_GROUP_INFINITE;
        bounds.axis = {0, -1, 0};
        bounds.cosSpread = l.upperHemisphereOnly ? 0 : -1;
        bounds.power = luminance(l.color) * glm::pi<double>();
        break;
    case LightKind::Area:
        packed.kindAndFlags = LIGHT_QUAD;
        appendRows(packed.parameters, rectangle(l));
        break;
    }
#undef PACK_LIGHT
    return packed;
}

} // namespace stromboli
