// What textures and normal maps make of the point of a surface.
#include "host/reference/surface.hpp"

#include "host/reference/sampling.hpp"
#include "scene/model/mixture.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace stromboli::reference {

namespace {

PointAttributes attributesOf(const SurfacePoint& s, const Scene& scene) {
    if (s.triangle == kNoPrimitive) return {};
    return attributesAt(scene, s.triangle, s.b1, s.b2);
}

void multiply(glm::vec3& parameter, const glm::dvec3& factor) {
    parameter = glm::vec3(glm::dvec3(parameter) * factor);
}
void multiply(float& parameter, double factor) {
    parameter = float(parameter * factor);
}

void multiplyBaseColor(Material& m, const glm::dvec3& color) {
    if (glm::vec3* base = m.baseColor()) multiply(*base, color);
}

/// What is rough somewhere is nowhere made smooth: it stays of one kind.
void multiplyRoughness(Material& m, double along, double across) {
    const bool canBeRough = m.kind == MaterialKind::Conductor || m.kind == MaterialKind::Dielectric;
    if (!canBeRough || m.isSmooth()) return;
    multiply(m.facets.alpha.x, along);
    multiply(m.facets.alpha.y, across);
    m.facets.alpha = m.facetAlpha();
}

bool hasSpecularColor(const Material& m) {
    return m.kind == MaterialKind::ThinDielectric || m.kind == MaterialKind::Plastic ||
           (m.kind == MaterialKind::Dielectric && !m.isSmooth());
}

/// Numbers have slots of the principled material's numbers.
void apply(BurleyParameters& p, TextureSlot slot, const glm::dvec4& texel) {
    switch (slot) {
    case TextureSlot::MetallicRoughness:
        multiply(p.roughness, texel.g);
        return multiply(p.metallic, texel.b);
    case TextureSlot::Transmission:
        return multiply(p.transmission, texel.r);
    case TextureSlot::Specular:
        return multiply(p.specularTint, texel.a);
    case TextureSlot::SpecularColor:
        multiply(p.flatness, texel.r);
        return multiply(p.diffuseTransmission, texel.g);
    case TextureSlot::Clearcoat:
        return multiply(p.clearcoat, texel.r);
    case TextureSlot::ClearcoatRoughness:
        return multiply(p.clearcoatGloss, texel.g);
    case TextureSlot::SheenColor:
        return multiply(p.sheen, texel.r);
    case TextureSlot::SheenRoughness:
        return multiply(p.sheenTint, texel.a);
    case TextureSlot::Anisotropy:
        return multiply(p.anisotropy, texel.b);
    default:
        return;
    }
}

void apply(Material& m, TextureSlot slot, const glm::dvec4& texel) {
    if (m.kind == MaterialKind::Burley) apply(m.burley, slot, texel);
    PrincipledParameters& p = m.principled;
    const glm::dvec3 color(texel);
    switch (slot) {
    case TextureSlot::BaseColor:
        return multiplyBaseColor(m, color);
    case TextureSlot::Emission:
        return multiply(m.emission, color);
    case TextureSlot::MetallicRoughness:
        multiply(p.roughness, texel.g);
        multiplyRoughness(m, texel.g, texel.b);
        return multiply(p.metallic, texel.b);
    case TextureSlot::Transmission:
        return multiply(p.transmission, texel.r);
    case TextureSlot::Specular:
        return multiply(p.specular, texel.a);
    case TextureSlot::SpecularColor:
        if (hasSpecularColor(m)) multiply(m.reflectance, color);
        return multiply(p.specularColor, color);
    case TextureSlot::Clearcoat:
        return multiply(p.clearcoat, texel.r);
    case TextureSlot::ClearcoatRoughness:
        return multiply(p.clearcoatRoughness, texel.g);
    case TextureSlot::SheenColor:
        return multiply(p.sheenColor, color);
    case TextureSlot::SheenRoughness:
        return multiply(p.sheenRoughness, texel.a);
    case TextureSlot::Anisotropy:
        multiply(p.anisotropy, texel.b);
        p.anisotropyRotation += float(std::atan2(2 * texel.g - 1, 2 * texel.r - 1));
        return;
    case TextureSlot::DiffuseTransmission:
        return multiply(p.diffuseTransmission, texel.a);
    case TextureSlot::DiffuseTransmissionColor:
        return multiply(p.diffuseTransmissionColor, color);
    case TextureSlot::Iridescence:
        return multiply(p.iridescence, texel.r);
    case TextureSlot::FilmThickness:
        return multiply(p.filmSpan, texel.g);
    case TextureSlot::Normal:
    case TextureSlot::ClearcoatNormal:
    case TextureSlot::Height:
    case TextureSlot::BlendShare:
    case TextureSlot::Projection:
    case TextureSlot::Opacity:
        return; // no parameter
    }
}

/// The tangent of the surface as it is seen, perpendicular to the shading normal.
glm::dvec4 tangentOf(const SurfacePoint& s, const Scene& scene, const Material& m, bool isTurned) {
    if (s.triangle == kNoPrimitive) return glm::dvec4(0.0);
    const uint32_t set = uvSetOfTangents(m);
    const double weights[] = {1 - s.b1 - s.b2, s.b1, s.b2};
    glm::dvec3 sum(0.0);
    double side = 0;
    for (uint32_t c = 0; c < 3; ++c) {
        const glm::dvec4 corner(tangentAtCorner(scene, s.triangle, c, set));
        if (corner.w == 0) return glm::dvec4(0.0);
        sum += weights[c] * glm::normalize(glm::dvec3(corner));
        side = corner.w;
    }
    sum -= glm::dot(sum, s.shading) * s.shading;
    if (!(glm::dot(sum, sum) > 0)) return glm::dvec4(0.0);
    // The bitangent stays where it is when the normal is turned.
    return {glm::normalize(sum), isTurned ? -side : side};
}

/// Takes what a map has made of the shading normal, as the material has it.
void settleNormal(SurfacePoint& s, const glm::dvec3& mapped, bool bends,
                  const ShadingConventions& conventions) {
    const glm::dvec3 n = s.shading;
    s.shading = mapped;
    if (!conventions.facesForward) return;
    switch (s.material->reliefRule) {
    case ReliefRule::Bend:
        if (bends) s.shading = bendNormal(mapped, s.geometric, s.wo);
        return;
    case ReliefRule::Flip: { // the part along n stays
        const glm::dvec3 along = glm::dot(mapped, n) * n;
        if (glm::dot(mapped, s.wo) <= 0) s.shading = along - (mapped - along);
        return;
    }
    case ReliefRule::Blacken:
        return;
    }
}

/// By what heights and the tilt of mapped normals are multiplied.
double reliefScale(const SurfacePoint& s, const TextureUse& map) {
    return s.material->mirrorsReliefBehind && s.isFromBehind ? -map.scale : map.scale;
}

/// Raises the surface by heights over the texture coordinates u and v (Blinn 1978): its derivatives
/// along them, made perpendicular to the shading normal n, get n times the height's. How n itself
/// changes along them is left out, as usual.
void applyHeights(SurfacePoint& s, const Scene& scene, const TextureUse& map,
                  const ShadingConventions& conventions) {
    const auto& corners = scene.attributeCorners[s.triangle];
    if (corners[0] == kNoAttributes) return;
    const Triangle& t = scene.triangles[s.triangle];
    const auto position = [&](int c) { return glm::dvec3(scene.positions[t.corner[c]]); };
    const auto uv = [&](int c) { return glm::dvec2(scene.attributes[corners[c]].uv[0]); };
    const glm::dmat2 uvEdges(uv(1) - uv(0), uv(2) - uv(0));
    const double determinant = glm::determinant(uvEdges);
    if (!(std::abs(determinant) > 0)) return; // no derivatives
    const glm::dmat2x3 edges(position(1) - position(0), position(2) - position(0));
    const glm::dmat2x3 byUv = edges * glm::inverse(uvEdges);
    // Seen from behind, a bump is a dent.
    const bool isTurned = conventions.facesForward && !s.outside;
    const glm::dvec2 slope =
        (isTurned ? -1.0 : 1.0) * reliefScale(s, map) * slopeOf(scene, map, attributesOf(s, scene));
    if (slope == glm::dvec2(0.0)) return;
    const glm::dvec3& n = s.shading;
    const glm::dvec3 alongU = byUv[0] + (slope.x - glm::dot(n, byUv[0])) * n;
    const glm::dvec3 alongV = byUv[1] + (slope.y - glm::dot(n, byUv[1])) * n;
    const glm::dvec3 raised = glm::cross(alongU, alongV);
    const double length = glm::length(raised), side = glm::dot(raised, n);
    if (!(length > 0 && std::isfinite(length) && side != 0)) return;
    // Light of what mirrors goes where the view decides, and would be lost below the surface.
    const bool mirrors = s.material->kind != MaterialKind::Diffuse;
    settleNormal(s, raised / (side > 0 ? length : -length), mirrors, conventions);
}

/// What a map makes of the shading normal, unit; nothing where it leaves it alone.
std::optional<glm::dvec3> mappedNormal(const SurfacePoint& s, const Scene& scene,
                                       const TextureUse& map, double scale,
                                       const glm::dvec4& tangent, bool isTurned) {
    const glm::dvec3 texel(lookUp(scene, map, attributesOf(s, scene)));
    const glm::dvec2 tilt = (2.0 * glm::dvec2(texel) - 1.0) * scale;
    if (tilt == glm::dvec2(0.0)) return std::nullopt;
    const glm::dvec3 t(tangent), b = tangent.w * glm::cross(s.shading, t);
    // The map is that of the front; from behind, its vector is turned round as the normal is.
    const glm::dvec3 across = tilt.x * t + tilt.y * b;
    const glm::dvec3 n = (isTurned ? -across : across) + (2 * texel.z - 1) * s.shading;
    if (!(glm::dot(n, n) > 0)) return std::nullopt;
    return glm::normalize(n);
}

} // namespace

namespace {

/// All materials of a mixture but the one that has been drawn.
void noteOthers(SurfacePoint& s, const Scene& scene, std::span<const uint32_t> mixture,
                const PointAttributes& at) {
    double left = 1;
    for (const uint32_t i : mixture) {
        const Material& m = scene.materials[i];
        const double next = i == mixture.back() ? 0 : otherShareAt(scene, m, at);
        const double share = left * (1 - next);
        left *= next;
        if (&m == s.material)
            s.share = share;
        else if (share > 0)
            s.others.push_back({{std::shared_ptr<void>(), &m}, share}); // the scene's
    }
}

} // namespace

void drawMaterial(SurfacePoint& s, const Scene& scene, RandomStream& random) {
    const PointAttributes at = attributesOf(s, scene);
    const OtherPlace notThere = isSeenFromBehind(s) ? OtherPlace::InFront : OtherPlace::Behind;
    std::vector<uint32_t> together; // from the first material on that scatters with all behind it
    const auto note = [&] {
        if (s.material->other == kNoMaterial || !together.empty()) return;
        const auto number = uint32_t(s.material - scene.materials.data());
        together = materialsOfMixture(scene.materials, number);
        if (!areEvaluatedTogether(scene.materials, together)) together.clear();
    };
    note();
    while (s.material->other != kNoMaterial && s.material->otherPlace != notThere &&
           random.next() < otherShareAt(scene, *s.material, at)) {
        s.material = s.stated = &scene.materials[s.material->other];
        note();
    }
    noteOthers(s, scene, together, at);
}

void takeMaterialOfSide(SurfacePoint& s, const Scene& scene) {
    const OtherPlace there = isSeenFromBehind(s) ? OtherPlace::Behind : OtherPlace::InFront;
    if (s.material->other != kNoMaterial && s.material->otherPlace == there)
        s.material = s.stated = &scene.materials[s.material->other];
}

void applyTextures(SurfacePoint& s, const Scene& scene) {
    const PointAttributes at = attributesOf(s, scene);
    const auto textured = [&](const Material& m) {
        std::shared_ptr<Material> own;
        if (m.textures.empty() && at.color == glm::dvec4(1.0)) return own;
        own = std::make_shared<Material>(m);
        multiplyBaseColor(*own, glm::dvec3(at.color));
        for (const TextureUse& use : m.textures)
            apply(*own, use.slot, lookUp(scene, use, at));
        return own;
    };
    for (SurfacePoint::Part& part : s.others)
        if (const auto own = textured(*part.material)) part.material = own;
    if (const auto own = textured(*s.material)) {
        s.material = own.get();
        s.ownMaterial = own;
    }
}

/// glTF's clear coat is not turned by the base's map, but by its own.
void findCoatNormal(SurfacePoint& s, const Scene& scene, const ShadingConventions& conventions) {
    const TextureUse* map = textureIn(*s.material, TextureSlot::ClearcoatNormal);
    const bool hasCoat =
        s.material->kind == MaterialKind::Principled && s.material->principled.clearcoat > 0;
    if (!hasCoat || (!map && !textureIn(*s.material, TextureSlot::Normal))) return;
    s.coat = s.unmapped;
    if (!map) return;
    const bool isTurned = conventions.facesForward && !s.outside;
    SurfacePoint unmapped = s;
    unmapped.shading = s.unmapped;
    const glm::dvec4 tangent = tangentOf(unmapped, scene, *s.material, isTurned);
    if (tangent.w == 0) return;
    const std::optional<glm::dvec3> n =
        mappedNormal(unmapped, scene, *map, map->scale, tangent, isTurned);
    if (n) s.coat = bendNormal(*n, s.geometric, s.wo);
}

void applyNormalMap(SurfacePoint& s, const Scene& scene, const ShadingConventions& conventions) {
    findCoatNormal(s, scene, conventions);
    if (const TextureUse* heights = textureIn(*s.material, TextureSlot::Height))
        if (s.triangle != kNoPrimitive) applyHeights(s, scene, *heights, conventions);
    const TextureUse* map = textureIn(*s.material, TextureSlot::Normal);
    const auto hasGrain = [](const SurfacePoint::Part& p) { return p.material->hasGrain(); };
    if (!map && !s.material->hasGrain() && std::ranges::none_of(s.others, hasGrain)) return;
    const bool isTurned = conventions.facesForward && !s.outside;
    s.tangent = tangentOf(s, scene, *s.material, isTurned);
    if (!map || s.tangent.w == 0) return;
    const std::optional<glm::dvec3> n =
        mappedNormal(s, scene, *map, reliefScale(s, *map), s.tangent, isTurned);
    if (!n) return;
    settleNormal(s, *n, true, conventions);
    s.tangent = tangentOf(s, scene, *s.material, isTurned);
}

glm::dvec3 bendNormal(const glm::dvec3& n, const glm::dvec3& g, const glm::dvec3& wo) {
    const double facing = glm::dot(n, g), height = glm::dot(wo, g);
    const glm::dvec3 mirrored = 2 * glm::dot(n, wo) * n - wo;
    if (facing > 0 && glm::dot(mirrored, g) >= 0) return n;
    // Pulled up along n to the horizon; from a normal below the horizon, to where that points.
    const glm::dvec3 grazing =
        facing > 0 ? mirrored - glm::dot(mirrored, g) / facing * n : height * (n - facing * g);
    const double length = glm::length(grazing);
    const glm::dvec3 sum = length > 0 && std::isfinite(length) ? wo + grazing / length : g;
    return glm::dot(sum, sum) > 0 ? glm::normalize(sum) : g;
}

} // namespace stromboli::reference
