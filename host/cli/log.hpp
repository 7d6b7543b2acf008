#pragma once

#include <string_view>

namespace stromboli {

/// What is said: errors only, warnings too, information too, or everything.
enum class Verbosity { ErrorsOnly, Quiet, Normal, Verbose };

/// From now on messages go to standard error, without time stamps, down to this verbosity. `before`
/// is called before each that appears: it clears what is drawn there.
void setUpLogging(Verbosity verbosity, void (*before)() = nullptr);

/// Changes what is said from now on.
void setVerbosity(Verbosity verbosity);

/// Messages, one line each: control characters in them, which may come from a file, are shown
/// (printable()). Callers format them: the logging library's headers, which are slow to
/// compile, are in log.cpp alone.
namespace logging {
void debug(std::string_view message);
void info(std::string_view message);
void warn(std::string_view message);
void error(std::string_view message);
} // namespace logging

} // namespace stromboli
