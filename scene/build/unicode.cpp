#include "scene/build/unicode.hpp"

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

} // namespace stromboli::build
