#include "scene/build/subsurface.hpp"

#include "scene/build/fresnel.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>

namespace stromboli::build {

glm::dvec3 Scattering::albedo() const {
    glm::dvec3 result(0.0);
    for (const int c : {0, 1, 2})
        if (extinction()[c] > 0) result[c] = scattered[c] / extinction()[c];
    return result;
}

std::optional<Scattering> measuredMedium(std::string_view name) {
    static const std::map<std::string, Scattering> media{
        {"skin1", {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}}},
        {"skin2", {{1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}}},
        {"apple", {{2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}}},
        {"chicken1", {{0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}}},
        {"chicken2", {{0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}}},
        {"cream", {{7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}}},
        {"ketchup", {{0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}}},
        {"marble", {{2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}}},
        {"potato", {{0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}}},
        {"skimmilk", {{0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}}},
        {"wholemilk", {{2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}}},
        {"spectralon", {{11.6, 20.4, 14.9}, {0, 0, 0}}},
    };
    std::string small(name);
    std::ranges::transform(small, small.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    const auto found = media.find(small);
    return found == media.end() ? std::nullopt : std::optional(found->second);
}

double reflectanceOfDepth(double albedo, double g) {
    const double s = std::sqrt(std::max(1 - albedo, 0.0) / std::max(1 - albedo * g, 1e-9));
    return std::clamp((1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s), 0.0, 1.0);
}

double albedoOfDepth(double reflectance, double g) {
    // (1 - s) (1 - 0.139 s) = R (1 + 1.17 s) is an equation of the second degree in s.
    const double r = std::clamp(reflectance, 0.0, 1.0), b = 1.139 + 1.17 * r;
    const double s = 2 * (1 - r) / (b + std::sqrt(b * b - 4 * 0.139 * (1 - r)));
    return std::clamp((1 - s * s) / (1 - g * s * s), 0.0, 1.0);
}

double albedoUnderInterface(double reflectance, double g, double ior) {
    // Out comes R (1 - F) of what has come in, and R F is sent back to come again: with r for the
    // sum, R = r / (1 - F + r F).
    const double back = internalReflection(ior), r = std::clamp(reflectance, 0.0, 1.0);
    return albedoOfDepth(r / (1 - back + r * back), g);
}

Scattering scatteringUnder(const glm::dvec3& reflectance, const glm::dvec3& meanFreePath, double g,
                           double ior) {
    Scattering s;
    for (const int c : {0, 1, 2}) {
        const double albedo = albedoUnderInterface(reflectance[c], g, ior);
        s.scattered[c] = albedo / meanFreePath[c];
        s.absorbed[c] = (1 - albedo) / meanFreePath[c];
    }
    return s;
}

} // namespace stromboli::build
