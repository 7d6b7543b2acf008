#include "scene/build/hair_color.hpp"

#include <cmath>

namespace stromboli::build {

glm::dvec3 absorptionOfHair(double eumelanin, double pheomelanin) {
    return eumelanin * glm::dvec3(0.419, 0.697, 1.37) + pheomelanin * glm::dvec3(0.187, 0.4, 1.05);
}

glm::dvec3 colorOfHair(const glm::dvec3& absorption, double roughness) {
    const double b = roughness;
    const double width = 5.969 - 0.215 * b + 2.532 * b * b - 10.73 * std::pow(b, 3) +
                         5.574 * std::pow(b, 4) + 0.245 * std::pow(b, 5);
    return glm::exp(-glm::sqrt(glm::max(absorption, 0.0)) * width);
}

} // namespace stromboli::build
