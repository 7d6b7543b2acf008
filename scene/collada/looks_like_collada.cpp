#include "scene/collada/load_collada.hpp"

namespace stromboli {
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

} // namespace

bool looksLikeCollada(std::string_view text) {
    skip(text, "\xEF\xBB\xBF"); // the mark of UTF-8
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
    if (!skip(text, "<COLLADA")) return false;
    return text.empty() ||
           std::string_view(" \t\r\n/>").find(text.front()) != std::string_view::npos;
}

} // namespace stromboli
