#pragma once

#include <string>

namespace stromboli {

/// This process's command line as it was typed, but for quotes.
std::string commandLine();

} // namespace stromboli
