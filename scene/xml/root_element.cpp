#include "scene/xml/root_element.hpp"

#include "scene/build/unicode.hpp"

#include <optional>
#include <string>

namespace stromboli::xml {
namespace {

/// Takes `prefix` away from the front of `text`, if it is there.
bool skip(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix)) return false;
    text.remove_prefix(prefix.size());
    return true;
}

/// Takes everything up to and with `end` away; all of it where there is no end.
void skipPast(std::string_view& text, std::string_view end) {
    const size_t at = text.find(end);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + end.size());
}

void skipSpaces(std::string_view& text) {
    const size_t at = text.find_first_not_of(" \t\r\n");
    text.remove_prefix(at == std::string_view::npos ? text.size() : at);
}

/// The beginning of a text in UTF-16 as UTF-8; empty if it is none.
std::string fromUtf16(std::string_view beginning, const build::Utf16Beginning& utf16) {
    if (utf16.marked) beginning.remove_prefix(2);
    if (beginning.size() % 2 != 0) beginning.remove_suffix(1);
    // Where it is cut may be in the middle of a character of two units.
    for (const size_t cut : {size_t(0), size_t(2)})
        if (cut <= beginning.size())
            if (const std::optional<std::string> text =
                    build::utf8FromUtf16(beginning.substr(0, beginning.size() - cut), utf16.order))
                return *text;
    return {};
}

bool beginsWithElement(std::string_view text, std::string_view name) {
    for (;;) {
        skipSpaces(text);
        if (skip(text, "<?"))
            skipPast(text, "?>");
        else if (skip(text, "<!--"))
            skipPast(text, "-->");
        else if (skip(text, "<!"))
            skipPast(text, ">"); // <!DOCTYPE>
        else
            break;
    }
    if (!skip(text, "<") || !skip(text, name)) return false;
    return text.empty() ||
           std::string_view(" \t\r\n/>").find(text.front()) != std::string_view::npos;
}

} // namespace

bool hasRootElement(std::string_view beginning, std::string_view name) {
    if (const auto utf16 = build::utf16Beginning(beginning))
        return beginsWithElement(fromUtf16(beginning, *utf16), name);
    skip(beginning, "\xEF\xBB\xBF"); // the mark of UTF-8
    return beginsWithElement(beginning, name);
}

} // namespace stromboli::xml
