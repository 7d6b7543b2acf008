#include "host/core/page_text.hpp"

namespace stromboli {

/// "</script>" ends a script element, and "<!--" with "<script" behind it hides that end.
std::string forScript(std::string_view json) {
    std::string escaped;
    escaped.reserve(json.size());
    for (const char c : json) {
        if (c == '<')
            escaped += "\\u003c";
        else
            escaped += c;
    }
    return escaped;
}

std::string filledIn(std::string_view page,
                     std::span<const std::pair<std::string_view, std::string_view>> marks) {
    std::string filled;
    for (const auto& [mark, text] : marks) {
        const size_t at = page.find(mark);
        filled.append(page.substr(0, at)).append(text);
        page.remove_prefix(at + mark.size());
    }
    return filled.append(page);
}

std::string toBase64(std::string_view bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

} // namespace stromboli
