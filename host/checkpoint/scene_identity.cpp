#include "host/checkpoint/scene_identity.hpp"

#include <zlib.h>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

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

/// Those of the value's laterMembers() that are not the default, with their numbers: a state saved
/// before it had them stays that of its scene.
template <class T>
void addLater(Sum& sum, const T& value) {
    const T standard{};
    [[maybe_unused]] const auto members = laterMembers(value), usual = laterMembers(standard);
    [&]<size_t... i>(std::index_sequence<i...>) {
        [[maybe_unused]] const auto addOne = [&](size_t number, const auto& member,
                                                 const auto& other) {
            if (member != other) sum.add(uint64_t(number)), sum.add(member);
        };
        (addOne(i, std::get<i>(members), std::get<i>(usual)), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(members)>>());
}

// laterMembers() name all members of these: one more is an error there. Structured bindings do so
// here.

void add(Sum& sum, const PrincipledParameters& p) {
    sum.add(p.baseColor), sum.add(p.metallic), sum.add(p.roughness), sum.add(p.ior);
    sum.add(p.specular), sum.add(p.specularColor), sum.add(p.clearcoat);
    sum.add(p.clearcoatRoughness), sum.add(p.sheenColor), sum.add(p.sheenRoughness);
    sum.add(p.anisotropy), sum.add(p.anisotropyRotation), sum.add(p.transmission);
    sum.add(p.isThin), sum.add(p.attenuationColor), sum.add(p.attenuationDistance);
    addLater(sum, p);
}

void add(Sum& sum, const BurleyParameters& b) {
    sum.add(b.baseColor), sum.add(b.metallic), sum.add(b.roughness), sum.add(b.anisotropy);
    sum.add(b.ior), sum.add(b.specularTint), sum.add(b.transmission), sum.add(b.sheen);
    sum.add(b.sheenTint), sum.add(b.flatness), sum.add(b.clearcoat), sum.add(b.clearcoatGloss);
    sum.add(b.isThin), sum.add(b.diffuseTransmission);
    addLater(sum, b);
}

void add(Sum& sum, const TextureUse& t) {
    const auto& [slot, texture, uvSet, uRow, vRow, scale] = t;
    sum.add(slot), sum.add(texture), sum.add(uvSet), sum.add(uRow), sum.add(vRow), sum.add(scale);
}

/// Kinds whose facets are of the scene's identity: all that came with facets or after them, also
/// those that have none.
bool hasFacets(MaterialKind kind) {
    switch (kind) {
    case MaterialKind::Diffuse:
    case MaterialKind::Mirror:
    case MaterialKind::Refraction:
    case MaterialKind::Principled:
        return false;
    case MaterialKind::Conductor:
    case MaterialKind::Dielectric:
    case MaterialKind::ThinDielectric:
    case MaterialKind::Plastic:
    case MaterialKind::Burley:
        return true;
    }
    return true;
}

void add(Sum& sum, const Material& m) {
    const auto& [distribution, facetAlpha, masking] = m.facets;
    sum.add(m.kind), sum.add(m.albedo), sum.add(m.reflectance), sum.add(m.transmittance);
    sum.add(m.ior), sum.add(m.eta), sum.add(m.k), sum.add(m.emission), sum.add(m.emitsBothSides);
    // A state saved before materials had these stays that of its scene.
    if (hasFacets(m.kind)) sum.add(distribution), sum.add(facetAlpha), sum.add(m.isNonlinear);
    if (masking != FacetMasking::Correlated) sum.add(masking);
    if (m.internalViews > 0) sum.add(m.internalViews);
    add(sum, m.principled);
    if (m.kind == MaterialKind::Burley) add(sum, m.burley);
    if (m.isBlackBehind) sum.add(m.isBlackBehind);
    if (m.hasReliefRules()) sum.add(m.reliefRule), sum.add(m.reliefShadows);
    if (m.isHiddenFromCamera) sum.add(2);
    if (m.other != kNoMaterial) sum.add(m.other), sum.add(m.otherShare);
    if (m.otherPlace != OtherPlace::ByShare) sum.add(m.otherPlace);
    sum.add(m.alphaMode), sum.add(m.opacity), sum.add(m.alphaCutoff);
    for (const TextureUse& t : m.textures)
        add(sum, t);
    addLater(sum, m);
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
    const auto& [name, width, height, radiance, strength, rotation, rowsReachPoles] = e;
    sum.add(width), sum.add(height), sum.addAll(radiance), sum.add(strength), sum.add(rotation);
    sum.add(rowsReachPoles);
}

template <class Value>
void add(Sum& sum, const Grid<Value>& grid) {
    const auto& [size, values, toUnit] = grid;
    sum.add(size), sum.addAll(values);
    for (const glm::dvec4& row : toUnit)
        sum.add(row);
}

void add(Sum& sum, const Medium& m) {
    const auto& [name, absorption, scattering, emission, phase, asymmetry, otherPhases,
                 isUnderSurface, density, colors] = m;
    sum.add(absorption), sum.add(scattering), sum.add(emission), sum.add(phase);
    sum.add(asymmetry);
    for (const PhaseLobe& lobe : otherPhases)
        sum.add(lobe.phase), sum.add(lobe.asymmetry), sum.add(lobe.share);
    if (isUnderSurface) sum.add(uint32_t(5));
    if (density) add(sum, *density);
    const auto& [extinctionColors, scatteringColors, isFactor, source, glow] = colors;
    if (extinctionColors) sum.add(uint32_t(1)), add(sum, *extinctionColors);
    if (scatteringColors) sum.add(uint32_t(2)), add(sum, *scatteringColors), sum.add(isFactor);
    if (source) sum.add(uint32_t(3)), add(sum, *source);
    if (glow) sum.add(glow->coldest), sum.add(glow->hottest), sum.addAll(glow->values);
}

void add(Sum& sum, const Light& l) {
    sum.add(l.kind), sum.add(l.color), sum.add(l.position), sum.add(l.direction);
    sum.add(l.constantAttenuation), sum.add(l.linearAttenuation), sum.add(l.quadraticAttenuation);
    sum.add(l.falloffAngle), sum.add(l.falloffExponent), sum.add(l.upperHemisphereOnly);
    sum.add(l.edgeX), sum.add(l.edgeY);
    if (l.innerAngle) sum.add(*l.innerAngle);
    if (l.picture) add(sum, *l.picture);
    if (l.isFramed) sum.add(l.isFramed);
    addLater(sum, l);
}

void add(Sum& sum, const Camera& c) {
    const auto& [orthographic, position, right, up, back, halfWidth, halfHeight, shift,
                 nearDistance, farDistance, clipAlongRay, lensRadius, focusDistance, medium] = c;
    sum.add(orthographic), sum.add(position), sum.add(right), sum.add(up), sum.add(back);
    sum.add(halfWidth), sum.add(halfHeight), sum.add(shift), sum.add(nearDistance);
    sum.add(farDistance);
    sum.add(clipAlongRay), sum.add(lensRadius), sum.add(focusDistance);
    if (medium != kNoMedium) sum.add(medium);
}

static_assert(sizeof(Triangle) == 8 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(Sphere) == 6 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(Prototype) == 2 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(Placement) == 14 * sizeof(uint32_t), "has padding, or a new member");
static_assert(sizeof(VertexAttributes) == 12 * sizeof(float), "has padding, or a new member");
static_assert(sizeof(Portal) == 9 * sizeof(float), "has padding, or a new member");
static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

} // namespace

uint32_t environmentIdentity(const Environment& environment) {
    Sum sum;
    add(sum, environment);
    return sum.value();
}

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
    if (!scene.portals.empty()) sum.addAll(scene.portals);
    // A scene without media has the sum that it had before there were any.
    for (const Medium& m : scene.media)
        add(sum, m);
    add(sum, camera);
    return sum.value();
}

} // namespace stromboli
