#include "host/checkpoint/scene_identity.hpp"

#include <zlib.h>

#include <type_traits>

namespace stromboli {
namespace {

/// Member by member: the padding between them means nothing.
class Sum {
  public:
    uint32_t value() const { return value_; }

    template <class T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
        addBytes(&value, sizeof value);
    }
    template <glm::length_t n, class T>
    void add(const glm::vec<n, T>& v) {
        for (glm::length_t i = 0; i < n; ++i)
            add(v[i]);
    }
    /// Elements without padding, as they lie.
    template <class T>
    void addAll(const std::vector<T>& elements) {
        add(uint64_t(elements.size()));
        addBytes(elements.data(), elements.size() * sizeof(T));
    }

  private:
    void addBytes(const void* bytes, size_t count) {
        if (count == 0) return; // an empty vector may have no address, which zlib takes for a start
        value_ = uint32_t(crc32_z(value_, static_cast<const Bytef*>(bytes), count));
    }

    uint32_t value_ = 0;
};

// Structured bindings name all members: one more is an error here.

void add(Sum& sum, const PrincipledParameters& p) {
    const auto& [baseColor, metallic, roughness, ior, specular, specularColor, clearcoat,
                 clearcoatRoughness, sheenColor, sheenRoughness, anisotropy, rotation, transmission,
                 isThin, attenuationColor, attenuationDistance] = p;
    sum.add(baseColor), sum.add(metallic), sum.add(roughness), sum.add(ior), sum.add(specular);
    sum.add(specularColor), sum.add(clearcoat), sum.add(clearcoatRoughness), sum.add(sheenColor);
    sum.add(sheenRoughness), sum.add(anisotropy), sum.add(rotation), sum.add(transmission);
    sum.add(isThin), sum.add(attenuationColor), sum.add(attenuationDistance);
}

void add(Sum& sum, const BurleyParameters& b) {
    const auto& [baseColor, metallic, roughness, anisotropy, ior, specularTint, transmission, sheen,
                 sheenTint, flatness, clearcoat, clearcoatGloss, isThin, diffuseTransmission] = b;
    sum.add(baseColor), sum.add(metallic), sum.add(roughness), sum.add(anisotropy), sum.add(ior);
    sum.add(specularTint), sum.add(transmission), sum.add(sheen), sum.add(sheenTint);
    sum.add(flatness), sum.add(clearcoat), sum.add(clearcoatGloss), sum.add(isThin);
    sum.add(diffuseTransmission);
}

void add(Sum& sum, const TextureUse& t) {
    const auto& [slot, texture, uvSet, uRow, vRow, scale] = t;
    sum.add(slot), sum.add(texture), sum.add(uvSet), sum.add(uRow), sum.add(vRow), sum.add(scale);
}

void add(Sum& sum, const Material& m) {
    const auto& [name, kind, albedo, reflectance, transmittance, ior, eta, k, facets, isNonlinear,
                 internalViews, emission, bothSides, principled, burley, alphaMode, opacity,
                 alphaCutoff, other, otherShare, otherPlace, isHiddenFromCamera, isBlackBehind,
                 reliefRule, reliefShadows, textures] = m;
    const auto& [distribution, facetAlpha, masking] = facets;
    sum.add(kind), sum.add(albedo), sum.add(reflectance), sum.add(transmittance), sum.add(ior);
    sum.add(eta), sum.add(k), sum.add(emission), sum.add(bothSides);
    // A state saved before materials had these stays that of its scene.
    if (kind >= MaterialKind::Conductor)
        sum.add(distribution), sum.add(facetAlpha), sum.add(isNonlinear);
    if (masking != FacetMasking::Correlated) sum.add(masking);
    if (internalViews > 0) sum.add(internalViews);
    add(sum, principled);
    if (kind == MaterialKind::Burley) add(sum, burley);
    if (isBlackBehind) sum.add(isBlackBehind);
    if (reliefRule != ReliefRule::Bend || reliefShadows)
        sum.add(reliefRule), sum.add(reliefShadows);
    if (isHiddenFromCamera) sum.add(2);
    if (other != kNoMaterial) sum.add(other), sum.add(otherShare);
    if (otherPlace != OtherPlace::ByShare) sum.add(otherPlace);
    sum.add(alphaMode), sum.add(opacity), sum.add(alphaCutoff);
    for (const TextureUse& t : textures)
        add(sum, t);
}

void add(Sum& sum, const TextureImage& i) {
    const auto& [name, width, height, format, words, goesBeyond] = i;
    sum.add(width), sum.add(height), sum.add(format), sum.addAll(words);
}

void add(Sum& sum, const Texture& t) {
    const auto& [image, wrapU, wrapV, nearest, srgb] = t;
    sum.add(image), sum.add(wrapU), sum.add(wrapV), sum.add(nearest), sum.add(srgb);
}

void add(Sum& sum, const Environment& e) {
    const auto& [name, width, height, radiance, strength, rotation] = e;
    sum.add(width), sum.add(height), sum.addAll(radiance), sum.add(strength), sum.add(rotation);
}

void add(Sum& sum, const Light& l) {
    const auto& [name, kind, color, position, direction, constant, linear, quadratic, angle,
                 exponent, innerAngle, upperOnly, edgeX, edgeY, picture, isFramed] = l;
    sum.add(kind), sum.add(color), sum.add(position), sum.add(direction), sum.add(constant);
    sum.add(linear), sum.add(quadratic), sum.add(angle), sum.add(exponent), sum.add(upperOnly);
    sum.add(edgeX), sum.add(edgeY);
    if (innerAngle) sum.add(*innerAngle);
    if (picture) add(sum, *picture);
    if (isFramed) sum.add(isFramed);
}

void add(Sum& sum, const Camera& c) {
    const auto& [orthographic, position, right, up, back, halfWidth, halfHeight, shift,
                 nearDistance, farDistance, clipAlongRay, lensRadius, focusDistance] = c;
    sum.add(orthographic), sum.add(position), sum.add(right), sum.add(up), sum.add(back);
    sum.add(halfWidth), sum.add(halfHeight), sum.add(shift), sum.add(nearDistance);
    sum.add(farDistance);
    sum.add(clipAlongRay), sum.add(lensRadius), sum.add(focusDistance);
}

static_assert(sizeof(Triangle) == 8 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(Sphere) == 6 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(Prototype) == 2 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(Placement) == 14 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(VertexAttributes) == 12 * sizeof(float), "has padding, or a new member");
static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

} // namespace

uint32_t sceneIdentity(const Scene& scene, const Camera& camera) {
    Sum sum;
    sum.addAll(scene.positions);
    sum.addAll(scene.normals);
    sum.addAll(scene.triangles);
    sum.addAll(scene.spheres);
    sum.addAll(scene.prototypes);
    sum.addAll(scene.placements);
    for (const Material& m : scene.materials)
        add(sum, m);
    for (const Light& l : scene.lights)
        add(sum, l);
    for (const TextureImage& i : scene.images)
        add(sum, i);
    for (const Texture& t : scene.textures)
        add(sum, t);
    sum.addAll(scene.attributes);
    sum.addAll(scene.attributeCorners);
    if (scene.environment) add(sum, *scene.environment);
    add(sum, camera);
    return sum.value();
}

} // namespace stromboli
