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

/// The text of a file in UTF-8 without a byte order mark: files in UTF-16 are converted, all others
/// are left as they are. Nothing if it begins as UTF-16 and is none.
std::optional<std::string> textInUtf8(std::string bytes);

/// The text with each byte that belongs to no character of UTF-8 as the character of that code
/// (Latin-1), as older programs of western Europe write names.
std::string utf8WithLatin1(std::string_view text);

/// A text of UTF-8 with one byte for each character; nothing if one has no such code.
std::optional<std::string> latin1FromUtf8(std::string_view text);

} // namespace stromboli::build
