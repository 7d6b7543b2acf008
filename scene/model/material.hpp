#pragma once

#include "scene/model/medium.hpp"
#include "scene/model/texture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace stromboli {

enum class MaterialKind : uint32_t {
    Diffuse,        ///< Lambert: albedo / pi
    Mirror,         ///< perfect reflection: reflectance
    Refraction,     ///< perfect transmission without Fresnel: transmittance, ior
    Principled,     ///< glTF's metallic-roughness model and its extensions: principled
    Conductor,      ///< reflectance, eta, k, facets
    Dielectric,     ///< an interface: reflectance, transmittance, ior, facets
    ThinDielectric, ///< a sheet with all reflections inside it: reflectance, transmittance, ior
    Plastic, ///< a diffuse base under a dielectric: albedo, reflectance, ior, facets, isNonlinear
    Burley,  ///< the principled materials of Burley 2012 and 2015, as Mitsuba has them: burley
};

/// How the normals of microfacets are distributed (Walter et al. 2007).
enum class FacetDistribution : uint32_t { Ggx, Beckmann };

/// How much of a microfacet is seen from one direction and lit from another, by what Smith's model
/// says of each direction alone.
enum class FacetMasking : uint32_t {
    Correlated, ///< what is low is hidden from both (Heitz 2014): 1 / (1 + Lambda(wo) + Lambda(wi))
    Separable,  ///< as if heights were independent (Walter et al. 2007): the product of both
};

/// The microfacets of an interface. They are smooth, an interface that light meets as a plane,
/// where both alphas are too small for floats to tell (Material::isSmooth).
struct Facets {
    FacetDistribution distribution = FacetDistribution::Ggx;
    /// Along the surface's tangent and across it: RMS slope times sqrt(2) of Beckmann's
    /// distribution and what corresponds to it in GGX. Plastic has the first for both.
    glm::vec2 alpha{0.0f};
    FacetMasking masking = FacetMasking::Correlated;
};

/// glTF 2.0's metallic-roughness material with KHR_materials_ior, specular, clearcoat, sheen,
/// anisotropy, transmission, diffuse_transmission, volume, dispersion and iridescence. Roughness is
/// glTF's: the GGX parameter is its square.
struct PrincipledParameters {
    glm::vec3 baseColor{1.0f};
    float metallic = 1;
    float roughness = 1;
    float ior = 1.5f; ///< index inside / index outside
    float specular = 1;
    glm::vec3 specularColor{1.0f};
    float clearcoat = 0, clearcoatRoughness = 0;
    glm::vec3 sheenColor{0.0f};
    float sheenRoughness = 0;
    float anisotropy = 0;         ///< strength, [0, 1]
    float anisotropyRotation = 0; ///< radians from the tangent towards the bitangent
    float transmission = 0;
    bool isThin = true; ///< without a volume behind the surface: light goes straight through
    /// Volume: the share of light that is left after attenuationDistance (metres).
    glm::vec3 attenuationColor{1.0f};
    float attenuationDistance = std::numeric_limits<float>::infinity();
    /// The share of what is scattered diffusely that goes to the other side, and its colour.
    float diffuseTransmission = 0;
    glm::vec3 diffuseTransmissionColor{1.0f};
    float dispersion = 0; ///< of the volume: 20 / its Abbe number; 0: none
    /// The strength of interference in a thin film on the surface; its index and its thickness in
    /// nanometres. Textures multiply the span, which is added to the thickness.
    float iridescence = 0;
    float filmIor = 1.3f, filmThickness = 400, filmSpan = 0;

    bool passesDiffusely() const { return diffuseTransmission > 0 && metallic < 1; }
    /// A plane that reflects light or lets it through, and nothing else: clear glass.
    bool isClear() const;
    /// Half the difference between the indices of blue and red light, `ior` being that of green, by
    /// the volume's dispersion; 0 where there is none.
    float indexSpread() const;
    /// The absorption coefficient of the volume, per metre (Beer and Lambert): attenuationColor is
    /// exp(-absorption attenuationDistance). A channel that lets nothing through gets the largest
    /// one whose product with a length is finite.
    glm::vec3 absorption() const;
};

/// Burley's principled BSDF of 2012 and 2015 as Mitsuba 3 has it: a sum of lobes, all parameters in
/// [0, 1] but the index.
struct BurleyParameters {
    glm::vec3 baseColor{0.5f};
    float metallic = 0;
    float roughness = 0.5f;
    float anisotropy = 0;
    float ior = 1.5f; ///< index inside / index outside
    float specularTint = 0;
    float transmission = 0;
    float sheen = 0, sheenTint = 0;
    float flatness = 0; ///< of diffuse reflection, towards scattering under the surface
    float clearcoat = 0, clearcoatGloss = 0;
    bool isThin = false;           ///< without metal and coat; light goes straight through
    float diffuseTransmission = 0; ///< thin: the share of what is diffuse

    bool transmits() const;
    /// An index of 1 has no facets that refract.
    float usedIor() const;
    /// Neither alpha of the facets is less.
    float leastAlpha() const;
};

/// Where a surface is not there, so that light passes through it unchanged.
enum class AlphaMode : uint32_t {
    Opaque, ///< opacity has no meaning
    Mask,   ///< there where opacity is at least alphaCutoff
    Blend,  ///< opacity is the share of light that meets the surface
};

/// No material of the scene.
inline constexpr uint32_t kNoMaterial = 0xFFFFFFFFu;

/// What becomes of a normal that heights or a map of normals turn away from the viewer.
enum class ReliefRule : uint8_t {
    Bend,   ///< bent until what it mirrors is there (Keller et al. 2017); diffuse: stays
    Flip,   ///< tilted as much to the other side (Schuessler et al. 2017)
    Blacken ///< the surface is black there
};

/// When another material takes the place of the one that a surface has.
enum class OtherPlace : uint8_t {
    ByShare, ///< in a share of cases, by chance
    Behind,  ///< seen from where the shading normals do not point
    InFront, ///< seen from where they do
};

/// What a surface does with light. Only the members its kind names are meaningful; emission is
/// meaningful for all (an emitter is a diffuse material of albedo 0 that emits).
struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::Diffuse;
    glm::vec3 albedo{0.5f};        ///< Diffuse: fraction reflected, per colour channel
    glm::vec3 reflectance{1.0f};   ///< of mirrors, and a factor of what interfaces reflect
    glm::vec3 transmittance{1.0f}; ///< a factor of what interfaces transmit
    float ior = 1.5f;              ///< of dielectrics: index inside / index outside
    glm::vec3 eta{1.0f};           ///< of conductors: real part of the index of refraction
    glm::vec3 k{0.0f};             ///< of conductors: extinction coefficient
    Facets facets;
    bool isNonlinear = false; ///< Plastic: the base's colour deepens with reflections inside
    /// Plastic with facets: the share of diffuse light that the interface sends back to the base is
    /// the mean over so many equidistant cosines, both ends included, as Mitsuba takes it: 1.6 %
    /// less than the integral with 64 of them. 0: the integral.
    uint32_t internalViews = 0;
    glm::vec3 emission{0.0f};   ///< emitted radiance, W sr^-1 m^-2 (scene units of power)
    bool emitsBothSides = true; ///< false: only on the side the geometric normal points to
    PrincipledParameters principled;
    BurleyParameters burley;
    AlphaMode alphaMode = AlphaMode::Opaque;
    float opacity = 1; ///< times the alpha of texture and vertex colour
    float alphaCutoff = 0.5f;
    /// A mixture: light that meets the surface finds, in that share of cases, the other material of
    /// the scene in this one's place, which may be a mixture too. Opacity and emission are this
    /// one's; the other one has the same emission. On one side only: otherShare is 1.
    uint32_t other = kNoMaterial;
    float otherShare = 0;
    OtherPlace otherPlace = OtherPlace::ByShare;
    /// Camera rays pass it, up to the first surface that they meet; all others meet it.
    bool isHiddenFromCamera = false;
    bool isBlackBehind = false; ///< nothing is scattered to where the normals do not point
    ReliefRule reliefRule = ReliefRule::Bend;
    /// Bumps dim light that comes at grazing angles, as facets would (Conty Estevez, Lecocq and
    /// Stein 2019).
    bool reliefShadows = false;
    /// Light that passes the surface comes into another medium: `inside` on the side that the
    /// geometric normal, as stored, does not point to, `outside` on the other one. Indices of
    /// Scene::media, or kNoMedium.
    bool boundsMedia = false;
    uint32_t inside = kNoMedium, outside = kNoMedium;
    /// The border of a volume that may overlap others, whose media are the first of the scene:
    /// outside of it is what else the place is in, of several the last one, and else `outside`.
    bool outsideIsOpen = false;
    /// Behind the surface heights and maps of normals are seen in a mirror: what stands out in
    /// front does so there, too. Else a bump is a dent from behind.
    bool mirrorsReliefBehind = false;
    /// At most one for each slot, but of MetallicRoughness, Emission and SpecularColor, whose
    /// numbers multiply.
    std::vector<TextureUse> textures;

    bool emits() const { return emission.x > 0 || emission.y > 0 || emission.z > 0; }
    /// True where no light sample can ever contribute: the BSDF is a delta distribution.
    bool isDelta() const;
    /// Whether the interface of a conductor, a dielectric or plastic is a plane; of the principled
    /// model, whether it is clear glass all over.
    bool isSmooth() const;
    bool hasReliefRules() const { return reliefRule != ReliefRule::Bend || reliefShadows; }
    /// Both alphas of the facets that light meets, where the interface is not smooth.
    glm::vec2 facetAlpha() const;
    /// Whether light may pass the surface into what it bounds.
    bool entersVolume() const;
    /// Opacity is 0 everywhere: a surface between two media and nothing else.
    bool isNull() const { return alphaMode == AlphaMode::Blend && opacity == 0 && !emits(); }
    /// The surface looks different along its tangent and across it.
    bool hasGrain() const;
    /// What textures of the base colour and the colours of corners multiply; none: nullptr.
    glm::vec3* baseColor();
    const glm::vec3* baseColor() const { return const_cast<Material*>(this)->baseColor(); }
};

/// Members that came after the first checkpoints, for host/checkpoint, which counts those that are
/// not the default; and all members by name, so that a new one is not forgotten. A new one goes
/// behind the last and into the tuple.
inline auto laterMembers(const PrincipledParameters& p) {
    [[maybe_unused]] const auto& [baseColor, metallic, roughness, ior, specular, specularColor,
                                  clearcoat, clearcoatRoughness, sheenColor, sheenRoughness,
                                  anisotropy, rotation, transmission, isThin, attenuationColor,
                                  attenuationDistance, diffuseTransmission, diffuseColor,
                                  dispersion, iridescence, filmIor, filmThickness, filmSpan] = p;
    return std::tie(p.diffuseTransmission, p.diffuseTransmissionColor, p.dispersion, p.iridescence,
                    p.filmIor, p.filmThickness, p.filmSpan);
}
inline auto laterMembers(const BurleyParameters& b) {
    [[maybe_unused]] const auto& [baseColor, metallic, roughness, anisotropy, ior, specularTint,
                                  transmission, sheen, sheenTint, flatness, clearcoat,
                                  clearcoatGloss, isThin, diffuseTransmission] = b;
    return std::tie();
}
inline auto laterMembers(const Material& m) {
    [[maybe_unused]] const auto& [name, kind, albedo, reflectance, transmittance, ior, eta, k,
                                  facets, isNonlinear, internalViews, emission, emitsBothSides,
                                  principled, burley, alphaMode, opacity, alphaCutoff, other,
                                  otherShare, otherPlace, isHiddenFromCamera, isBlackBehind,
                                  reliefRule, reliefShadows, boundsMedia, inside, outside,
                                  outsideIsOpen, mirrorsReliefBehind, textures] = m;
    return std::tie(m.boundsMedia, m.inside, m.outside, m.outsideIsOpen, m.mirrorsReliefBehind);
}

/// Below these, floats cannot tell microfacets from a plane (shaders/shared/bsdf_types.h has the
/// reasons): the parameter of the distribution, and that times what refraction turns of it.
inline constexpr float kLeastAlpha = 1e-4f;
inline constexpr float kLeastRefractionAlpha = 0x1p-15f;

} // namespace stromboli
