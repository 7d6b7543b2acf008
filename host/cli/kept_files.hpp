#pragma once

#include "host/cli/options.hpp"

#include <string>

namespace stromboli {

// Files that renders leave while they go on: checkpoints, and films of shares. Both are replaced
// whole, so that what is read is complete, of one moment.

/// Whether `info` says how far the render is that the file, or the checkpoints of bands beside that
/// name, are of.
bool isKeptRender(const std::string& file);
/// Prints it, or writes it as JSON. Returns the exit code.
int infoOfKeptRender(const std::string& file, const std::string& jsonFile);

/// Whether the file is a checkpoint, or there are some of bands beside that name.
bool isKeptPicture(const std::string& file);
/// Writes the picture that a checkpoint, or those of bands, hold as it is by now. Throws
/// UsageError, OutputError.
int mergeCheckpoint(const std::string& file, const MergeOptions& options);

} // namespace stromboli
