#pragma once

#include "host/cli/options.hpp"

namespace stromboli {

/// Each runs one command and returns the program's exit code; errors are thrown.
int renderCommand(const Options& options);
/// `render` with --pixel and --sample: prints that sample's radiance and whether it is rejected.
int sampleCommand(const Options& options);
int checkCommand(const Options& options);
int infoCommand(const Options& options);
int kernelsCommand(const Options& options);
int devicesCommand(const Options& options);
int benchCommand(const Options& options);
int compareCommand(const Options& options);
int mergeCommand(const Options& options);
int planCommand(const Options& options);
int submitCommand(const Options& options);
int studyCommand(const Options& options);
int stressCommand(const Options& options);

} // namespace stromboli
