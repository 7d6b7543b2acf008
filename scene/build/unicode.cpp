#include "scene/build/unicode.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace stromboli::build {
namespace {

void appendUtf8(std::string& text, uint32_t code) {
    const auto continuation = [&](int shift) { text += char(0x80 | ((code >> shift) & 0x3F)); };
    if (code < 0x80) {
        text += char(code);
    } else if (code < 0x800) {
        text += char(0xC0 | (code >> 6));
        continuation(0);
    } else if (code < 0x10000) {
        text += char(0xE0 | (code >> 12));
        continuation(6), continuation(0);
    } else {
        text += char(0xF0 | (code >> 18));
        continuation(12), continuation(6), continuation(0);
    }
}

bool isHighSurrogate(uint32_t unit) {
    return unit >= 0xD800 && unit < 0xDC00;
}

bool isLowSurrogate(uint32_t unit) {
    return unit >= 0xDC00 && unit < 0xE000;
}

} // namespace

std::optional<Utf16Beginning> utf16Beginning(std::string_view bytes) {
    if (bytes.size() < 2) return std::nullopt;
    const auto first = uint8_t(bytes[0]), second = uint8_t(bytes[1]);
    if (first == 0xFF && second == 0xFE) return Utf16Beginning{ByteOrder::LittleEndian, true};
    if (first == 0xFE && second == 0xFF) return Utf16Beginning{ByteOrder::BigEndian, true};
    const auto isText = [](uint8_t c) { return c >= 0x20 && c < 0x7F; };
    if (isText(first) && second == 0) return Utf16Beginning{ByteOrder::LittleEndian, false};
    if (first == 0 && isText(second)) return Utf16Beginning{ByteOrder::BigEndian, false};
    return std::nullopt;
}

std::optional<std::string> utf8FromUtf16(std::string_view bytes, ByteOrder order) {
    if (bytes.size() % 2 != 0) return std::nullopt;
    const size_t count = bytes.size() / 2, low = order == ByteOrder::LittleEndian ? 0 : 1;
    const auto unit = [&](size_t i) -> uint32_t {
        return uint32_t(uint8_t(bytes[2 * i + low])) | uint32_t(uint8_t(bytes[2 * i + 1 - low]))
                                                           << 8;
    };
    std::string text;
    text.reserve(count); // what markup and numbers take
    for (size_t i = 0; i < count; ++i) {
        const uint32_t first = unit(i);
        if (isLowSurrogate(first)) return std::nullopt;
        if (!isHighSurrogate(first)) {
            appendUtf8(text, first);
            continue;
        }
        if (++i == count || !isLowSurrogate(unit(i))) return std::nullopt;
        appendUtf8(text, 0x10000 + ((first - 0xD800) << 10) + (unit(i) - 0xDC00));
    }
    return text;
}

/// How many bytes the character at the beginning has (RFC 3629); 0: it is none.
static size_t lengthOfCharacter(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    const size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                          : first >= 0xE0 && first <= 0xEF ? 3
                          : first >= 0xF0 && first <= 0xF4 ? 4
                                                           : 0;
    if (length == 0 || text.size() < length) return 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    // The second byte tells codes that fewer bytes would hold, halves of UTF-16, and what is beyond
    // the last code.
    const unsigned char second = byte(1);
    const bool isWrong = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                         (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
    return isWrong ? 0 : length;
}

std::optional<std::string> textInUtf8(std::string bytes) {
    if (const std::optional<Utf16Beginning> utf16 = utf16Beginning(bytes))
        return utf8FromUtf16(std::string_view(bytes).substr(utf16->marked ? 2 : 0), utf16->order);
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    return bytes;
}

std::string utf8WithLatin1(std::string_view text) {
    std::string found;
    found.reserve(text.size());
    while (!text.empty()) {
        const size_t length = lengthOfCharacter(text);
        if (length == 0) {
            const auto code = static_cast<unsigned char>(text[0]);
            found += char(0xC0 | code >> 6);
            found += char(0x80 | (code & 0x3F));
        }
        found += text.substr(0, length);
        text.remove_prefix(std::max<size_t>(length, 1));
    }
    return found;
}

std::optional<std::string> latin1FromUtf8(std::string_view text) {
    std::string found;
    while (!text.empty()) {
        const size_t length = lengthOfCharacter(text);
        if (length == 0 || length > 2) return std::nullopt;
        const auto first = static_cast<unsigned char>(text[0]);
        const unsigned code =
            length == 1 ? first
                        : (first & 0x1Fu) << 6 | (static_cast<unsigned char>(text[1]) & 0x3Fu);
        if (code > 0xFF) return std::nullopt;
        found += char(code);
        text.remove_prefix(length);
    }
    return found;
}

} // namespace stromboli::build
