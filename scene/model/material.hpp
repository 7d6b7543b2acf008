#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>

namespace stromboli {

enum class MaterialKind : uint32_t {
    Diffuse,    ///< Lambert: albedo / pi
    Mirror,     ///< perfect reflection: reflectance
    Refraction, ///< perfect transmission without Fresnel: transmittance, ior
    Glass,      ///< smooth dielectric: reflectance, transmittance, ior
    Microfacet, ///< Beckmann conductor: alpha, eta, k
};

/// What a surface does with light. Only the members its kind names are meaningful; emission is
/// meaningful for all (an emitter is a diffuse material of albedo 0 that emits).
struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::Diffuse;
    glm::vec3 albedo{0.5f};        ///< Diffuse: fraction reflected, per colour channel
    glm::vec3 reflectance{1.0f};   ///< Mirror, Glass
    glm::vec3 transmittance{1.0f}; ///< Refraction, Glass
    float ior = 1.5f;              ///< Refraction, Glass: index inside / index outside
    float alpha = 0.1f;            ///< Microfacet: Beckmann roughness (RMS slope times sqrt 2)
    glm::vec3 eta{1.0f};           ///< Microfacet: real part of the index of refraction
    glm::vec3 k{0.0f};             ///< Microfacet: extinction coefficient
    glm::vec3 emission{0.0f};      ///< emitted radiance, W sr^-1 m^-2 (scene units of power)
    bool emitsBothSides = true;    ///< false: only on the side the geometric normal points to

    bool emits() const { return emission.x > 0 || emission.y > 0 || emission.z > 0; }
    /// True where no light sample can ever contribute: the BSDF is a delta distribution.
    bool isDelta() const {
        return kind == MaterialKind::Mirror || kind == MaterialKind::Refraction ||
               kind == MaterialKind::Glass;
    }
};

} // namespace stromboli
