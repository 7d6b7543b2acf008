#include "scene/collada/sources.hpp"

#include <fmt/format.h>

#include <array>

namespace stromboli::collada {
namespace {

template <size_t size>
using Places = std::array<uint64_t, size>;

template <size_t size>
struct Accessor {
    uint64_t count = 0, offset = 0, stride = 1;
    Places<size> component{}; ///< of x, y, z within one element
};

/// What messages call the components.
template <size_t size>
constexpr const char* kNames = size == 2 ? "S, T" : "X, Y, Z";

/// Which of an element's values are x, y and z: the first ones whose <param> has a name.
template <size_t size>
Places<size> components(const Document& document, const Element& accessor) {
    Places<size> places{}, inOrder{};
    for (size_t i = 0; i < size; ++i)
        inOrder[i] = i;
    uint64_t place = 0, found = 0;
    for (const Element& param : children(accessor)) {
        if (!named(param, "param")) continue;
        const char* name = param.Attribute("name");
        if (name && *name && found < size) places[found++] = place;
        ++place;
    }
    // Without any names the values are taken in order.
    if (found == 0) return inOrder;
    if (found < size)
        document.fail(accessor, fmt::format("has {} named <param>, expected {} ({})", found, size,
                                            kNames<size>));
    return places;
}

template <size_t size>
Accessor<size> readAccessor(const Document& document, const Element& at) {
    Accessor<size> accessor;
    accessor.count = readCount(document, at, "count");
    accessor.offset = readCountOr(document, at, "offset", 0);
    accessor.stride = readCountOr(document, at, "stride", 1);
    accessor.component = components<size>(document, at);
    if (accessor.component.back() >= accessor.stride)
        document.fail(at, fmt::format("stride=\"{}\" is too small for {}", accessor.stride,
                                      size == 2 ? "s and t" : "x, y and z"));
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

template <int size>
std::vector<glm::vec<size, double>> readVectors(const Document& document, const Element& source,
                                                NonFinite nonFinite) {
    const Element& at = document.require(document.require(source, "technique_common"), "accessor");
    const Accessor<size> accessor = readAccessor<size>(document, at);
    const std::vector<double> values =
        readArray(document, document.resolve(at, "source", "float_array"), nonFinite);
    if (accessor.count == 0) return {};
    // All operands are below 2^32, so that the sum fits in 64 bits.
    const uint64_t needed =
        accessor.offset + (accessor.count - 1) * accessor.stride + accessor.component.back() + 1;
    if (needed > values.size())
        document.fail(at,
                      fmt::format("needs {} numbers, but its array has {}", needed, values.size()));
    std::vector<glm::vec<size, double>> vectors(accessor.count);
    const double* element = values.data() + accessor.offset;
    for (glm::vec<size, double>& vector : vectors) {
        for (int i = 0; i < size; ++i)
            vector[i] = element[accessor.component[size_t(i)]];
        element += accessor.stride;
    }
    return vectors;
}

template std::vector<glm::dvec2> readVectors<2>(const Document&, const Element&, NonFinite);
template std::vector<glm::dvec3> readVectors<3>(const Document&, const Element&, NonFinite);

} // namespace stromboli::collada
