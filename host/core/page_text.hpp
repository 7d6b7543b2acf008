#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace stromboli {

/// JSON as it may stand in a script element of a page, whatever its strings are: none of them can
/// end the element, or begin another one.
std::string forScript(std::string_view json);

/// A page whose marks give way to texts, in the order in which they stand in it.
std::string filledIn(std::string_view page,
                     std::span<const std::pair<std::string_view, std::string_view>> marks);

/// RFC 4648, section 4, with padding.
std::string toBase64(std::string_view bytes);

} // namespace stromboli
