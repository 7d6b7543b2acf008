#pragma once

#include <string>

namespace stromboli {

/// This process's command line, quoted so that a shell would read it again.
std::string commandLine();

} // namespace stromboli
