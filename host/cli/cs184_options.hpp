#pragma once

#include "host/cli/declared_command.hpp"

namespace stromboli {

// The option that takes up the conventions of the CS184 renderer (host/cs184/cs184.hpp), and what
// is spelled as that renderer has it. The rest of the program asks for conventions by their names.

/// --cs184: what it sets, which defaults it changes, and what it does not go with.
void declareCs184(OptionList& list, SceneAndPicture& work, Asked& asked);

/// Rewrites what the CS184 renderer spells differently: `-f FILE` is `-o FILE`, `-o N` with a
/// whole number is `--accumulate N` (a picture's name has an extension, so they cannot be
/// confused), `-p` is `--cell`.
Words fromCs184Spelling(Words arguments);

} // namespace stromboli
