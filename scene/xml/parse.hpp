#pragma once

#include <tinyxml2.h>

#include <string>

namespace stromboli::xml {

/// Parses `text`, in UTF-8 or UTF-16, into `document`. Throws SceneError, with `file` and the line,
/// if it is not well-formed XML or has no element.
void parse(tinyxml2::XMLDocument& document, const std::string& file, const std::string& text);

} // namespace stromboli::xml
