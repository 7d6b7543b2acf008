#pragma once

#include "host/cli/declared_command.hpp"

namespace stromboli {

// Words of a command line that may be spelled in several ways, in the one that is parsed.

/// Digits and nothing else.
bool isWholeNumber(const std::string& word);

/// Words of an option that are one ("-r 640x360"), several ("--focus 320 180") or missing ("--watch
/// room.xml") as they are declared. Throws UsageError where a word that may be missing is announced
/// by an "=" and is not there.
Words inUsualSpelling(const OptionList& list, const Words& words);

/// "help render" is "render --help", and "help" is "--help".
Words withoutHelpCommand(const Words& words);

} // namespace stromboli
