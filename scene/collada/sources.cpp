#include "scene/collada/sources.hpp"

#include <fmt/format.h>

#include <array>

namespace stromboli::collada {
namespace {

struct Accessor {
    uint64_t count = 0, offset = 0, stride = 1;
    std::array<uint64_t, 3> component{0, 1, 2}; ///< places of x, y, z within one element
};

/// Which of an element's values are x, y and z: the first three whose <param> has a name.
std::array<uint64_t, 3> components(const Document& document, const Element& accessor) {
    std::array<uint64_t, 3> places{0, 1, 2};
    uint64_t place = 0, found = 0;
    for (const Element& param : children(accessor)) {
        if (!named(param, "param")) continue;
        const char* name = param.Attribute("name");
        if (name && *name && found < 3) places[found++] = place;
        ++place;
    }
    // Without any names the values are taken in order.
    if (found == 0) return {0, 1, 2};
    if (found < 3)
        document.fail(accessor, fmt::format("has {} named <param>, expected 3 (X, Y, Z)", found));
    return places;
}

Accessor readAccessor(const Document& document, const Element& at) {
    Accessor accessor;
    accessor.count = readCount(document, at, "count");
    accessor.offset = readCountOr(document, at, "offset", 0);
    accessor.stride = readCountOr(document, at, "stride", 1);
    accessor.component = components(document, at);
    if (accessor.component[2] >= accessor.stride)
        document.fail(at,
                      fmt::format("stride=\"{}\" is too small for x, y and z", accessor.stride));
    return accessor;
}

std::vector<double> readArray(const Document& document, const Element& at, NonFinite nonFinite) {
    std::vector<double> values = readNumbers(document, at, nonFinite);
    const uint32_t count = readCount(document, at, "count");
    if (values.size() != count)
        document.fail(at, fmt::format("has {} numbers, but count=\"{}\"", values.size(), count));
    return values;
}

} // namespace

std::vector<glm::dvec3> readVectors(const Document& document, const Element& source,
                                    NonFinite nonFinite) {
    const Element& at = document.require(document.require(source, "technique_common"), "accessor");
    const Accessor accessor = readAccessor(document, at);
    const std::vector<double> values =
        readArray(document, document.resolve(at, "source", "float_array"), nonFinite);
    if (accessor.count == 0) return {};
    // All operands are below 2^32, so that the sum fits in 64 bits.
    const uint64_t needed =
        accessor.offset + (accessor.count - 1) * accessor.stride + accessor.component[2] + 1;
    if (needed > values.size())
        document.fail(at,
                      fmt::format("needs {} numbers, but its array has {}", needed, values.size()));
    std::vector<glm::dvec3> vectors(accessor.count);
    const double* element = values.data() + accessor.offset;
    for (glm::dvec3& vector : vectors) {
        for (int i = 0; i < 3; ++i)
            vector[i] = element[accessor.component[i]];
        element += accessor.stride;
    }
    return vectors;
}

} // namespace stromboli::collada
