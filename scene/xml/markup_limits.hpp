#pragma once

#include <string>
#include <string_view>

namespace stromboli::xml {

/// Throws SceneError for XML that could not be parsed in the machine's memory, or not in a time
/// that grows as its length does. In one pass over the text, which need not be well-formed.
void checkMarkupLimits(const std::string& name, std::string_view text);

} // namespace stromboli::xml
