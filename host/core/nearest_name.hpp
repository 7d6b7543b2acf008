#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// How many letters have to be added, left out, replaced or swapped with their neighbour to make
/// one word of the other (the optimal string alignment distance).
size_t editDistance(const std::string& a, const std::string& b);

/// What may have been meant by a word that is none of the names: the only one that begins with it,
/// or the nearest one, if no more than one letter in three would have to change.
std::optional<std::string> nearestName(const std::string& word,
                                       const std::vector<std::string>& names);

/// "; did you mean render?", or nothing where no name is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names);

/// The file beside one that does not exist that may have been meant, by its name.
std::optional<std::string> nearestFile(const std::filesystem::path& missing);

/// "; did you mean room.xml?" for a file that does not exist; nothing where it does, or no file
/// beside it is near.
std::string didYouMeanFile(const std::filesystem::path& file);

} // namespace stromboli
