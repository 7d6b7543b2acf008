#pragma once

#include <string_view>

namespace stromboli::xml {

/// True if a file that begins like this, in UTF-8 or UTF-16, is XML whose root element has that
/// name.
bool hasRootElement(std::string_view beginning, std::string_view name);

} // namespace stromboli::xml
