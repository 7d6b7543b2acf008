#pragma once

#include "scene/gltf/document.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace stromboli::gltf {

/// The elements of an accessor, each of `width` numbers; normalised integers are fractions.
struct Values {
    size_t count = 0, width = 1;
    std::vector<double> numbers;

    const double* at(size_t i) const { return &numbers[i * width]; }
    glm::dvec2 vec2(size_t i) const { return {at(i)[0], at(i)[1]}; }
    glm::dvec3 vec3(size_t i) const { return {at(i)[0], at(i)[1], at(i)[2]}; }
    glm::dvec4 vec4(size_t i) const { return {at(i)[0], at(i)[1], at(i)[2], at(i)[3]}; }
};

/// Reads the accessor that a member names, with sparse substitutions. `width`: the numbers that an
/// element must have (0: any). Throws SceneError if it has others, or if bytes are missing, before
/// memory is taken for them.
Values readValues(const Document& document, size_t accessor, size_t width);

/// Reads an accessor of unsigned integers.
std::vector<uint32_t> readIndices(const Document& document, size_t accessor);

/// What an accessor states, for compressed primitives, whose bytes are elsewhere.
struct AccessorType {
    size_t count = 0, width = 1;
    size_t rows = 0; ///< of matrices
    int component = 0;
    bool normalized = false;
};
AccessorType typeOf(const Element& accessor);

/// The factor of a normalised integer: 1 / 255 for unsigned bytes; 1 if it is not normalised.
double normalization(const AccessorType& type);

} // namespace stromboli::gltf
