#pragma once

#include <spdlog/spdlog.h>

namespace stromboli {

enum class Verbosity { Quiet, Normal, Verbose };

/// Sends spdlog's default logger to standard error, without time stamps: warnings only when
/// quiet, information by default, debug when verbose.
void setUpLogging(Verbosity verbosity);

} // namespace stromboli
