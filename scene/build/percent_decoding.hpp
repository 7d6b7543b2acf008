#pragma once

#include <string>
#include <string_view>

namespace stromboli::build {

/// Text with `%20` and the like, as references are written, with the characters themselves.
std::string percentDecoded(std::string_view text);

} // namespace stromboli::build
