#include "host/core/printable.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace stromboli {
namespace {

/// The bytes that the UTF-8 character at the front of the text has; 0 if there is none: a stray or
/// missing continuation byte, a longer form than needed, a surrogate, or beyond U+10FFFF.
size_t characterLength(std::string_view text) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    const uint8_t first = byte(0);
    if (first < 0x80) return 1;
    const size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4) return 0;
    for (size_t i = 1; i < length; ++i)
        if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
    const uint8_t second = byte(1);
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
    if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
    return length;
}

/// U+0000 to U+001F, U+007F, and U+0080 to U+009F, which some terminals obey as well.
bool isControl(std::string_view character) {
    const auto first = uint8_t(character[0]);
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    return character.size() == 2 && first == 0xC2 && uint8_t(character[1]) < 0xA0;
}

std::string escaped(std::string_view bytes) {
    if (bytes == "\n") return "\\n";
    if (bytes == "\t") return "\\t";
    std::string text;
    for (const char c : bytes)
        text += fmt::format("\\x{:02x}", uint8_t(c));
    return text;
}

} // namespace

std::string printable(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const size_t length = characterLength(text);
        const std::string_view character = text.substr(0, length == 0 ? 1 : length);
        if (length == 0 || isControl(character))
            shown += escaped(character);
        else
            shown += character;
        text.remove_prefix(character.size());
    }
    return shown;
}

} // namespace stromboli
