#pragma once

#include <functional>
#include <string>

namespace stromboli {

/// How much a message matters.
enum class Severity { Detail, Information, Warning, Error };

/// Whoever is told what happens, in messages of one line; may be empty. Code below the command line
/// prints nothing itself.
using Messages = std::function<void(Severity, const std::string&)>;

inline void tell(const Messages& messages, Severity severity, const std::string& text) {
    if (messages) messages(severity, text);
}

} // namespace stromboli
