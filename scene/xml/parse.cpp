#include "scene/xml/parse.hpp"

#include "host/core/error.hpp"
#include "scene/build/unicode.hpp"
#include "scene/xml/markup_limits.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

namespace stromboli::xml {
namespace {

/// In words.
std::string describe(tinyxml2::XMLError error) {
    switch (error) {
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
        return "a tag is not written as <name ...>";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
        return "an attribute is not written as name=\"value\", or is there twice";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
        return "a text does not end";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
        return "a <![CDATA[ does not end";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
        return "a comment does not end";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
        return "a <? does not end, or stands behind the first element";
    case tinyxml2::XML_ERROR_PARSING_UNKNOWN:
        return "a <! does not end";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
        return "an element is not closed, or closed by another's tag";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
        return fmt::format("elements are nested more than {} deep", TINYXML2_MAX_ELEMENT_DEPTH);
    default:
        return "a '<' begins no tag";
    }
}

/// Documents end in the last tag; where another character is the last one, the end is missing.
bool isCutShort(std::string_view text) {
    const size_t last = text.find_last_not_of(" \t\r\n");
    return last != std::string_view::npos && text[last] != '>';
}

} // namespace

void parse(tinyxml2::XMLDocument& document, const std::string& file, const std::string& text) {
    if (build::utf16Beginning(text)) {
        const std::optional<std::string> converted = build::textInUtf8(text);
        if (!converted) throw SceneError(file, 0, "", "begins as UTF-16, but is none");
        return parse(document, file, *converted);
    }
    checkMarkupLimits(file, text);
    document.Parse(text.data(), text.size());
    if (document.Error())
        throw SceneError(file, document.ErrorLineNum(), "",
                         fmt::format("not well-formed XML: {}{}", describe(document.ErrorID()),
                                     isCutShort(text) ? "; the file is cut short" : ""));
    if (!document.RootElement()) throw SceneError(file, 0, "", "has no elements");
}

} // namespace stromboli::xml
