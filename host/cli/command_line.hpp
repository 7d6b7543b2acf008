#pragma once

#include <optional>
#include <string>
#include <vector>

namespace stromboli {

// Words of command lines.

/// A word as a shell would read it again.
std::string shellQuoted(const std::string& word);

/// This process's command line, quoted so that a shell would read it again.
std::string commandLine();

/// Rewrites what the CS184 renderer spells differently: `-f FILE` is `-o FILE`, `-o N` with a
/// whole number is `--accumulate N` (a picture's name has an extension, so they cannot be
/// confused), `-p` is `--cell`.
std::vector<std::string> fromCs184Spelling(std::vector<std::string> arguments);

/// What may have been meant by a word that is none of the names: the only one that begins with it,
/// or the nearest one, if no more than one letter in three would have to change.
std::optional<std::string> nearestName(const std::string& word,
                                       const std::vector<std::string>& names);

/// How many letters have to be added, left out, replaced or swapped with their neighbour to make
/// one word of the other (the optimal string alignment distance).
size_t editDistance(const std::string& a, const std::string& b);

} // namespace stromboli
