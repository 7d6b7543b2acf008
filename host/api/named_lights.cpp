#include "host/api/named_lights.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <string>

namespace stromboli::api {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

constexpr uint32_t lightBit(LightKind kind) {
    return 1u << uint32_t(kind);
}
using L = LightKind;
constexpr uint32_t kAllLights = ~0u;

struct LightParameter {
    const char* name;
    uint32_t kinds;
    size_t count;
    double least, most;
    const char* meaning;
    void (*set)(Light&, const glm::dvec3& origin, const glm::dvec3& value);
};
constexpr double kBrightest = 1e30, kFarthestLight = 0x1p60;
constexpr LightParameter kLightParameters[] = {
    {"color", kAllLights, 3, 0, kBrightest,
     "irradiance (directional), intensity (point, spot) or radiance",
     [](Light& l, const glm::dvec3&, const glm::dvec3& v) { l.color = v; }},
    {"position", lightBit(L::Point) | lightBit(L::Spot) | lightBit(L::Projector), 3,
     -kFarthestLight, kFarthestLight, "where it is, metres",
     [](Light& l, const glm::dvec3& origin, const glm::dvec3& v) { l.position = v - origin; }},
    {"direction", lightBit(L::Directional) | lightBit(L::Spot), 3, -kFarthestLight, kFarthestLight,
     "where the light goes",
     [](Light& l, const glm::dvec3&, const glm::dvec3& v) { l.direction = glm::normalize(v); }},
    {"angle", lightBit(L::Spot), 1, 1e-6, 180, "degrees of the whole cone",
     [](Light& l, const glm::dvec3&, const glm::dvec3& v) {
         l.falloffAngle = float(v.x * kRadiansPerDegree);
     }},
    {"inner_angle", lightBit(L::Spot), 1, 0, 180, "degrees of the cone in which it is undiminished",
     [](Light& l, const glm::dvec3&, const glm::dvec3& v) {
         l.innerAngle = float(v.x * kRadiansPerDegree);
     }},
};

const LightParameter& lightParameterOf(const Light& light, std::string_view parameter) {
    std::vector<std::string_view> names;
    for (const LightParameter& row : kLightParameters) {
        if ((row.kinds & lightBit(light.kind)) == 0) continue;
        if (row.name == parameter) return row;
        names.emplace_back(row.name);
    }
    throw UsageError(fmt::format("the light '{}' has no '{}': expected one of {}", light.name,
                                 parameter, fmt::join(names, ", ")));
}

} // namespace

void setLight(Light& light, const glm::dvec3& origin, std::string_view parameter,
              const Value& value) {
    const LightParameter& row = lightParameterOf(light, parameter);
    const bool isColor = parameter == "color";
    const auto refuse = [&] {
        throw UsageError(fmt::format("{} of the light '{}': expected {} from {:g} to {:g}",
                                     parameter, light.name,
                                     row.count == 1 ? "a number"
                                     : isColor      ? "3 numbers, or one for all"
                                                    : "3 numbers",
                                     row.least, row.most));
    };
    const auto* all = std::get_if<std::vector<double>>(&value);
    if (!all || (all->size() != row.count && !(isColor && all->size() == 1))) refuse();
    for (const double number : *all)
        if (!(number >= row.least && number <= row.most)) refuse();
    const glm::dvec3 vector =
        all->size() == 1 ? glm::dvec3(all->front()) : glm::dvec3((*all)[0], (*all)[1], (*all)[2]);
    if (parameter == "direction" && glm::length(vector) == 0)
        throw UsageError("direction of a light: expected a vector that is not 0");
    row.set(light, origin, vector);
}

void requireLight(const Light& light) {
    if (light.innerAngle && *light.innerAngle >= light.falloffAngle)
        throw UsageError("inner_angle of a spot: expected less than its angle");
}

std::vector<NamedThing> lightParameters(const Light& light) {
    std::vector<NamedThing> result;
    for (const LightParameter& row : kLightParameters)
        if (row.kinds & lightBit(light.kind)) result.push_back({row.name, row.meaning});
    return result;
}

} // namespace stromboli::api
