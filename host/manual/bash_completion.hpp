#pragma once

#include <string>

namespace stromboli {

/// A script for bash that completes commands, their options as they are declared, and the words
/// that these take.
std::string bashCompletion();

} // namespace stromboli
