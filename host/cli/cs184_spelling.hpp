#pragma once

#include <string>
#include <vector>

namespace stromboli {

/// Rewrites what the CS184 renderer spells differently: `-f FILE` is `-o FILE`, `-o N` with a
/// whole number is `--accumulate N` (a picture's name has an extension, so they cannot be
/// confused), `-p` is `--cell`.
std::vector<std::string> fromCs184Spelling(std::vector<std::string> arguments);

} // namespace stromboli
