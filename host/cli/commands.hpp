#pragma once

#include "host/cli/options.hpp"

namespace stromboli {

/// Each runs one command and returns the program's exit code; errors are thrown.
int renderCommand(const Options& options);
int checkCommand(const Options& options);
int infoCommand(const Options& options);
int devicesCommand(const Options& options);

} // namespace stromboli
