#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace stromboli::mitsuba {

/// Red, green and blue (linear, Rec. 709 primaries), taken as they are.
struct RgbValue {
    glm::dvec3 rgb{0.0};
};

/// One value for every wavelength, or values at some wavelengths, linear between them and 0
/// outside.
struct SpectrumValue {
    double everywhere = 0;
    std::vector<std::pair<double, double>> samples; ///< nanometres, ascending; empty: `everywhere`
};

/// What a parameter of a plugin is set to; points and vectors are dvec3.
using Value = std::variant<bool, int64_t, double, std::string, glm::dvec3, RgbValue, SpectrumValue,
                           glm::dmat4>;

/// In words, with an article.
std::string typeOf(const Value& value);

} // namespace stromboli::mitsuba
