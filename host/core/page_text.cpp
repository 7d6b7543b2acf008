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

} // namespace stromboli
