#pragma once

#include "host/cli/declared_command.hpp"

namespace stromboli {

/// The words that completion proposes for an option or operand; scenes by their names among them.
Words proposalsOf(const CommandOption& option);

} // namespace stromboli
