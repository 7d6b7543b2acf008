#include "scene/gltf/accessors.hpp"

#include "scene/build/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace stromboli::gltf {
namespace {

enum Component : int {
    kByte = 5120,
    kUnsignedByte = 5121,
    kShort = 5122,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126,
};

size_t sizeOf(int component) {
    switch (component) {
    case kByte:
    case kUnsignedByte:
        return 1;
    case kShort:
    case kUnsignedShort:
        return 2;
    default:
        return 4;
    }
}

size_t rowsOf(std::string_view type) {
    return type == "MAT2" ? 2 : type == "MAT3" ? 3 : type == "MAT4" ? 4 : 0;
}

size_t widthOf(const Element& accessor) {
    const std::string type = accessor.text("type");
    constexpr std::pair<std::string_view, size_t> widths[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, width] : widths)
        if (type == name) return width;
    accessor.fail("type", fmt::format("is '{}', expected SCALAR, VEC2, ... or MAT4", type));
}

template <class T>
T loaded(const char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

double componentAt(const char* from, int component) {
    switch (component) {
    case kByte:
        return loaded<int8_t>(from);
    case kUnsignedByte:
        return loaded<uint8_t>(from);
    case kShort:
        return loaded<int16_t>(from);
    case kUnsignedShort:
        return loaded<uint16_t>(from);
    case kUnsignedInt:
        return loaded<uint32_t>(from);
    default:
        return double(loaded<float>(from));
    }
}

/// Elements in the bytes of a view.
struct Layout {
    std::string_view bytes;
    size_t stride = 0;
};

/// Where `count` elements of `size` bytes lie that `at` states with view and offset; an error of
/// `at` if bytes are missing.
Layout layoutOf(const Document& document, const Element& at, size_t count, size_t size) {
    const std::optional<size_t> view = at.index("bufferView", document.size("bufferViews"));
    if (!view) at.fail("has no 'bufferView'");
    const std::string_view bytes = document.bytesOfView(*view);
    const uint64_t offset = at.count("byteOffset", 0);
    const uint64_t stride = document.at("bufferViews", *view).count("byteStride", size);
    // Elements may overlap only where the stride says so, and then they have at least a byte each.
    if (stride == 0 || stride > 4096)
        document.at("bufferViews", *view).fail("byteStride", fmt::format("is {}", stride));
    const bool fits = count == 0 || (offset <= bytes.size() && size <= bytes.size() - offset &&
                                     count - 1 <= (bytes.size() - offset - size) / stride);
    if (!fits)
        at.fail(fmt::format("{} elements of {} bytes, {} bytes apart, from byte {} on, are beyond "
                            "the {} bytes of bufferViews[{}]",
                            count, size, stride, offset, bytes.size(), *view));
    return {bytes.substr(std::min<uint64_t>(offset, bytes.size())), stride};
}

/// Columns of matrices begin at multiples of four bytes.
size_t columnSize(const AccessorType& type) {
    return (type.rows * sizeOf(type.component) + 3) / 4 * 4;
}

size_t elementSize(const AccessorType& type) {
    return type.rows > 0 ? type.rows * columnSize(type) : type.width * sizeOf(type.component);
}

void copyElement(const AccessorType& type, const char* from, double* to) {
    const size_t size = sizeOf(type.component);
    const double factor = normalization(type);
    for (size_t i = 0; i < type.width; ++i) {
        const size_t at =
            type.rows > 0 ? i / type.rows * columnSize(type) + i % type.rows * size : i * size;
        const double value = componentAt(from + at, type.component) * factor;
        // The two smallest codes both mean -1.
        to[i] = type.normalized ? std::max(value, -1.0) : value;
    }
}

void applySparse(const Document& document, const Element& accessor, const AccessorType& type,
                 Values& values) {
    const std::optional<Element> sparse = accessor.child("sparse");
    if (!sparse) return;
    const uint64_t count = sparse->count("count");
    const std::optional<Element> indices = sparse->child("indices"),
                                 stated = sparse->child("values");
    if (!indices || !stated) sparse->fail("lacks 'indices' or 'values'");
    const int component = int(indices->count("componentType"));
    if (component != kUnsignedByte && component != kUnsignedShort && component != kUnsignedInt)
        indices->fail("componentType",
                      fmt::format("is {}, expected 5121, 5123 or 5125", component));
    const Layout places = layoutOf(document, *indices, count, sizeOf(component));
    const Layout elements = layoutOf(document, *stated, count, elementSize(type));
    for (size_t i = 0; i < count; ++i) {
        const auto place = size_t(componentAt(places.bytes.data() + i * places.stride, component));
        if (place >= values.count)
            indices->fail(fmt::format("names element {} of {}", place, values.count));
        copyElement(type, elements.bytes.data() + i * elements.stride,
                    &values.numbers[place * values.width]);
    }
}

/// Without a view an accessor is zeros, of which a file of few bytes can state any number.
constexpr uint64_t kMostZeros = uint64_t(1) << 26;

} // namespace

AccessorType typeOf(const Element& accessor) {
    AccessorType type;
    type.count = accessor.count("count");
    type.width = widthOf(accessor);
    type.rows = rowsOf(accessor.text("type"));
    type.component = int(std::min<uint64_t>(accessor.count("componentType"), 1 << 20));
    type.normalized = accessor.flag("normalized", false);
    constexpr int known[] = {kByte, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt, kFloat};
    if (std::find(std::begin(known), std::end(known), type.component) == std::end(known))
        accessor.fail("componentType",
                      fmt::format("is {}, expected 5120 to 5123, 5125 or 5126", type.component));
    if (type.component == kFloat) type.normalized = false;
    return type;
}

double normalization(const AccessorType& type) {
    if (!type.normalized) return 1;
    switch (type.component) {
    case kByte:
        return 1.0 / 127;
    case kUnsignedByte:
        return 1.0 / 255;
    case kShort:
        return 1.0 / 32767;
    case kUnsignedShort:
        return 1.0 / 65535;
    case kUnsignedInt:
        return 1.0 / 4294967295.0;
    default:
        return 1;
    }
}

Values readValues(const Document& document, size_t index, size_t width) {
    const Element accessor = document.at("accessors", index);
    const AccessorType type = typeOf(accessor);
    if (width != 0 && type.width != width)
        accessor.fail("type", fmt::format("is '{}': elements have {} numbers, expected {}",
                                          accessor.text("type"), type.width, width));
    Values values{type.count, type.width, {}};
    std::optional<Layout> layout;
    if (accessor.has("bufferView"))
        layout = layoutOf(document, accessor, type.count, elementSize(type));
    else if (type.count > kMostZeros)
        accessor.fail("count",
                      fmt::format("is {}, without a 'bufferView' that holds them", type.count));
    build::requireMemory(document.file(), uint64_t(type.count) * type.width * sizeof(double));
    values.numbers.resize(type.count * type.width);
    for (size_t i = 0; layout && i < type.count; ++i)
        copyElement(type, layout->bytes.data() + i * layout->stride,
                    &values.numbers[i * type.width]);
    applySparse(document, accessor, type, values);
    return values;
}

std::vector<uint32_t> readIndices(const Document& document, size_t index) {
    const Element accessor = document.at("accessors", index);
    const AccessorType type = typeOf(accessor);
    if (type.component != kUnsignedByte && type.component != kUnsignedShort &&
        type.component != kUnsignedInt)
        accessor.fail("componentType", fmt::format("is {}, expected 5121, 5123 or 5125 for indices",
                                                   type.component));
    const Values values = readValues(document, index, 1);
    return {values.numbers.begin(), values.numbers.end()};
}

} // namespace stromboli::gltf
