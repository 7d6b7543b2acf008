#pragma once

#include "scene/model/material.hpp"

#include <string>
#include <utility>
#include <vector>

namespace stromboli::test {

/// A material that all tests of the BSDF contract are run on. A new closure adds its lines to
/// bsdfCases().
struct BsdfCase {
    std::string name;
    Material material;
    Material white;     ///< the same, absorbing nothing
    double leastWhite;  ///< share of the light from a view near the normal that `white` keeps
    bool smooth = true; ///< densities vary little over a twentieth of the hemisphere
    double lobe = 0;    ///< tangent within which half vectors mostly are; 0: all directions
    double error = 0; ///< relative, of values, weights and densities, besides directions' rounding
    double gain = 0;  ///< of fitted albedos: `white` may keep as much more than everything
    double leastGrazing = 0; ///< share of the light that `white` keeps from any view
    bool reciprocal = true;
};

/// Those of the principled kind.
std::vector<BsdfCase> principledCases();
/// Conductors, rough and thin dielectrics, plastic.
std::vector<BsdfCase> facetCases();

inline std::vector<BsdfCase> bsdfCases() {
    std::vector<BsdfCase> cases;
    const auto add = [&](std::string name, MaterialKind kind, auto&& change, double leastWhite) {
        BsdfCase c{std::move(name), {}, {}, leastWhite};
        c.material.kind = c.white.kind = kind;
        change(c.material);
        change(c.white);
        c.white.albedo = c.white.reflectance = c.white.transmittance = glm::vec3(1);
        c.white.eta = glm::vec3(1);
        c.white.k = glm::vec3(1e6f); // a perfect conductor reflects all
        cases.push_back(c);
    };
    add(
        "diffuse", MaterialKind::Diffuse,
        [](Material& m) {
            m.albedo = {0.8f, 0.5f, 0.02f};
        },
        1 - 1e-6);
    add(
        "mirror", MaterialKind::Mirror,
        [](Material& m) {
            m.reflectance = {0.9f, 0.5f, 0.1f};
        },
        1 - 1e-6);
    // Into the denser side radiance is compressed by the squared index: by 1 / 1.5^2.
    add(
        "refraction", MaterialKind::Refraction,
        [](Material& m) {
            m.transmittance = {0.9f, 0.5f, 0.1f};
        },
        0.44);
    add(
        "glass", MaterialKind::Dielectric,
        [](Material& m) {
            m.transmittance = {0.9f, 0.5f, 0.1f};
            m.reflectance = {0.8f, 0.4f, 0.2f};
        },
        0.44);
    for (const float alpha : {0.001f, 0.01f, 0.025f, 0.1f, 0.25f, 0.5f, 1.0f}) {
        const std::string digits = std::to_string(int(alpha * 1000));
        add(
            "roughConductor" + digits, MaterialKind::Conductor,
            [alpha](Material& m) {
                m.facets = {FacetDistribution::Beckmann, glm::vec2(alpha)};
                m.eta = {1.3352f, 1.0109f, 0.68955f};
                m.k = {7.3398f, 6.6157f, 5.6471f};
            },
            // What would be reflected twice is lost.
            alpha > 0.6f   ? 0.4
            : alpha > 0.3f ? 0.75
                           : 0.95);
        cases.back().smooth = alpha >= 0.25f;
        cases.back().lobe = alpha;
    }
    for (BsdfCase& c : principledCases())
        cases.push_back(std::move(c));
    for (BsdfCase& c : facetCases())
        cases.push_back(std::move(c));
    return cases;
}

inline std::vector<Material> materialsOf(const std::vector<BsdfCase>& cases) {
    std::vector<Material> materials;
    for (const BsdfCase& c : cases)
        materials.push_back(c.material);
    return materials;
}

} // namespace stromboli::test
