#pragma once

#include <string>

namespace stromboli {

/// A word as a shell would read it again.
std::string shellQuoted(const std::string& word);

/// This process's command line, quoted so that a shell would read it again.
std::string commandLine();

} // namespace stromboli
