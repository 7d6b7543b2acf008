#pragma once

#include <string>

namespace stromboli {

/// The manual page stromboli(1) in roff: all commands and their options as they are declared.
std::string manPage();

} // namespace stromboli
