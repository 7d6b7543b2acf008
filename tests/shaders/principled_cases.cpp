// Sets of parameters of the principled material on which all tests of the BSDF contract are run.
#include "shaders/shared/bsdf_types.h"
#include "tests/shaders/bsdf_cases.hpp"

#include <algorithm>

namespace stromboli::test {
namespace {

/// The coefficients of the fits of albedos reach 200, and 800 for sheen; float has them with that
/// many roundings of 2^-24, and albedos of .3 triple them.
constexpr double kFitError = 2e-4, kSheenFitError = 2e-3;
/// What the fits of the albedos miss (shaders/shared/albedo_fits.h).
constexpr double kFitGain = 0.0075 + 0.0042, kSheenGain = 0.02;

BsdfCase principled(std::string name, const PrincipledParameters& p) {
    BsdfCase c{std::move(name), {}, {}, 0};
    c.material.kind = c.white.kind = MaterialKind::Principled;
    c.material.principled = c.white.principled = p;
    c.white.principled.baseColor = c.white.principled.specularColor = glm::vec3(1);
    const float alpha = std::max(p.roughness * p.roughness, 1e-4f);
    const bool hasCoat = p.clearcoat > 0;
    const float coatAlpha = std::max(p.clearcoatRoughness * p.clearcoatRoughness, 1e-4f);
    const float narrowest = hasCoat ? std::min(alpha, coatAlpha) : alpha;
    c.lobe = narrowest;
    c.smooth = narrowest >= 0.2f;
    c.error = kFitError;
    c.gain = kFitGain;
    c.reciprocal = false;
    return c;
}

std::string percent(float x) {
    return std::to_string(int(x * 100 + 0.5f));
}

} // namespace

std::vector<BsdfCase> principledCases() {
    std::vector<BsdfCase> cases;
    PrincipledParameters coloured;
    coloured.baseColor = {0.9f, 0.6f, 0.3f};
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.7f, 1.0f}) {
        PrincipledParameters p = coloured;
        p.roughness = roughness;
        cases.push_back(principled("roughMetal" + percent(roughness), p));
        cases.back().leastWhite = cases.back().leastGrazing = 0.99;
        p.metallic = 0;
        cases.push_back(principled("plastic" + percent(roughness), p));
        cases.back().leastWhite = cases.back().leastGrazing = 0.99;
    }
    const auto add = [&](const char* name, float leastWhite, auto&& change) {
        PrincipledParameters p = coloured;
        p.metallic = 0;
        p.roughness = 0.5f;
        change(p);
        cases.push_back(principled(name, p));
        cases.back().leastWhite = leastWhite;
    };
    add("tintedSpecular", 0.97f, [](auto& p) {
        p.specular = 0.8f, p.specularColor = {0.9f, 0.5f, 0.2f}, p.ior = 1.8f;
    });
    add("halfMetal", 0.99f, [](auto& p) { p.metallic = 0.5f, p.roughness = 0.6f; });
    add("clearcoat", 0.97f,
        [](auto& p) { p.clearcoat = 0.8f, p.clearcoatRoughness = 0.1f, p.roughness = 0.8f; });
    add("roughClearcoatOnMetal", 0.97f,
        [](auto& p) { p.clearcoat = 1, p.clearcoatRoughness = 0.6f, p.metallic = 1; });
    add("anisotropic", 0.5f,
        [](auto& p) { p.metallic = 1, p.anisotropy = 0.7f, p.anisotropyRotation = 0.6f; });
    add("slightlyAnisotropicPlastic", 0.9f,
        [](auto& p) { p.anisotropy = 0.3f, p.anisotropyRotation = 2.5f, p.roughness = 0.4f; });
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        const std::string digits = percent(roughness);
        add("sheen", 0.9f, [&](auto& p) {
            p.sheenColor = {0.9f, 0.7f, 0.4f}, p.sheenRoughness = roughness;
        });
        cases.back().name += digits;
        cases.back().error = kSheenFitError;
        cases.back().gain += kSheenGain;
    }
    // Into the volume radiance is compressed by 1 / 1.5^2, and rough glass loses what its facets
    // would scatter again.
    for (const float roughness : {0.0f, 0.05f, 0.3f, 0.6f, 1.0f}) {
        const std::string digits = percent(roughness);
        add("thinGlass", 0.99f, [&](auto& p) { p.transmission = 1, p.roughness = roughness; });
        cases.back().name += digits;
        add("glassVolume", 0.3f,
            [&](auto& p) { p.transmission = 1, p.roughness = roughness, p.isThin = false; });
        cases.back().name += digits;
    }
    add("nearlyNoInterface", 0.9f,
        [](auto& p) { p.transmission = 1, p.isThin = false, p.ior = 1.0f, p.roughness = 0.3f; });
    // The error of a half vector whose length is that of the step of the index.
    cases.back().error = 30 * 0x1p-24 / double(gpu::LEAST_INDEX_STEP) / 0.09;
    add("lessDenseInside", 0.9f,
        [](auto& p) { p.transmission = 1, p.isThin = false, p.ior = 0.8f, p.roughness = 0.5f; });
    cases.back().gain += 1 / (0.8 * 0.8) - 1; // radiance is no longer compressed but stretched
    // What is diffuse goes to either side, without regard to the index of a volume.
    add("leaf", 0.97f, [](auto& p) {
        p.diffuseTransmission = 0.6f, p.diffuseTransmissionColor = {0.8f, 0.9f, 0.2f};
    });
    cases.back().white.principled.diffuseTransmissionColor = glm::vec3(1);
    add("wax", 0.97f, [](auto& p) {
        p.diffuseTransmission = 1, p.diffuseTransmissionColor = {0.9f, 0.5f, 0.2f};
        p.isThin = false, p.roughness = 0.3f, p.attenuationDistance = 1;
    });
    cases.back().white.principled.diffuseTransmissionColor = glm::vec3(1);
    add("waxAndGlass", 0.4f, [](auto& p) {
        p.diffuseTransmission = 0.5f, p.transmission = 0.5f, p.isThin = false, p.metallic = 0.1f;
        p.clearcoat = 0.5f, p.clearcoatRoughness = 0.5f, p.sheenColor = {0.2f, 0.3f, 0.1f};
        p.sheenRoughness = 0.6f;
    });
    cases.back().error = kSheenFitError;
    cases.back().gain += kSheenGain;
    // Directions of the colours differ, by more than a smooth lobe is wide.
    for (const float roughness : {0.0f, 0.3f}) {
        add("prism", 0.3f, [&](auto& p) {
            p.transmission = 1, p.isThin = false, p.ior = 1.6f, p.dispersion = 2;
            p.roughness = roughness;
        });
        cases.back().name += percent(roughness);
    }
    add("prismOfSmallIndex", 0.3f, [](auto& p) { // red is not refracted
        p.transmission = 1, p.isThin = false, p.ior = 1.25f, p.dispersion = 64, p.roughness = 0.5f;
    });
    cases.back().error = 30 * 0x1p-24 / double(gpu::LEAST_INDEX_STEP) / 0.25;
    cases.back().smooth = false; // red goes nearly straight on
    const auto film = [](auto& p) {
        p.iridescence = 0.75f, p.filmIor = 1.4f, p.filmThickness = 300, p.filmSpan = 150;
    };
    add("filmOnPlastic", 0.9f, [&](auto& p) { film(p); });
    add("filmOnRoughPlastic", 0.9f, [&](auto& p) { film(p), p.roughness = 0.9f; });
    add("filmOnMetal", 0.5f, [&](auto& p) { film(p), p.metallic = 1, p.roughness = 0.1f; });
    add("bubble", 0.9f, [](auto& p) {
        p.iridescence = 1, p.filmIor = 1.33f, p.filmThickness = 500, p.transmission = 1;
        p.roughness = 0.2f;
    });
    add("oilOnGlass", 0.3f, [](auto& p) {
        p.iridescence = 1, p.filmIor = 1.8f, p.filmThickness = 250, p.transmission = 1;
        p.roughness = 0.3f, p.isThin = false, p.specular = 0.5f;
    });
    add("mixture", 0.4f, [](auto& p) {
        p.transmission = 0.6f, p.isThin = false, p.metallic = 0.2f, p.clearcoat = 0.5f;
        p.clearcoatRoughness = 0.5f, p.sheenColor = {0.2f, 0.3f, 0.1f}, p.sheenRoughness = 0.6f;
        p.anisotropy = 0.5f, p.anisotropyRotation = 1.1f;
    });
    cases.back().error = kSheenFitError;
    cases.back().gain += kSheenGain;
    return cases;
}

} // namespace stromboli::test
