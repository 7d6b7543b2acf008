#pragma once

#include "scene/build/report.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::ply {

enum class Encoding { Ascii, LittleEndian, BigEndian };

enum class ScalarType {
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Float32,
    Float64,
    Int64,
    UInt64
};

size_t sizeOf(ScalarType type);

/// One number of each element, or a list of them with a number of its own for its length.
struct Property {
    std::string name; ///< as it is written: Mitsuba's attributes have capitals
    ScalarType type = ScalarType::Float32;
    std::optional<ScalarType> countType; ///< nothing: no list
};

/// A kind of elements, such as vertices, all of which have the same properties.
struct Element {
    std::string name; ///< in small letters
    uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::Ascii;
    std::vector<Element> elements; ///< in the order in which the file has them
    std::vector<std::string>
        pictures;   ///< of comments `TextureFile NAME`, as scanning programs write
    size_t end = 0; ///< where the elements begin, in bytes
    int lines = 0;  ///< how many lines it takes

    /// Nothing if there are none of this kind.
    const Element* find(std::string_view name) const;
};

/// Names in the letters by which they are compared.
std::string inSmallLetters(std::string_view name);

/// Throws SceneError, with the line, for what is no header.
Header readHeader(const std::string& file, std::string_view bytes, build::Report& report);

} // namespace stromboli::ply
