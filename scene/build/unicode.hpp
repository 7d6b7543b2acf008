#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stromboli::build {

enum class ByteOrder { LittleEndian, BigEndian };

/// How a text begins that is in UTF-16 and not in UTF-8.
struct Utf16Beginning {
    ByteOrder order;
    bool marked; ///< by a byte order mark, of two bytes
};

/// By its mark; without one, by its first character, which must then be ASCII. Nothing if the text
/// begins otherwise.
std::optional<Utf16Beginning> utf16Beginning(std::string_view bytes);

/// UTF-16 without its byte order mark as UTF-8; nothing if it is none: half a unit at its end, or
/// half a surrogate pair.
std::optional<std::string> utf8FromUtf16(std::string_view bytes, ByteOrder order);

} // namespace stromboli::build
