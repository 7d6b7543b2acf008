#pragma once

#include "host/cli/declared_command.hpp"

#include <string>

namespace stromboli {

/// The manual page stromboli(1) in roff: all commands and their options as they are declared.
std::string manPage();

/// The words that completion proposes for an option or operand; scenes by their names among them.
Words proposalsOf(const CommandOption& option);

/// A script for bash that completes commands, their options as they are declared, and the words
/// that these take.
std::string bashCompletion();

/// The completion script of fish, which also shows what each option means.
std::string fishCompletion();

/// The completion script of zsh, which also shows what each option and its words mean.
std::string zshCompletion();

} // namespace stromboli
