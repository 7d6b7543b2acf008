#pragma once

#include <string>
#include <variant>
#include <vector>

namespace stromboli::api {

/// What a name is given in a program: numbers (one, or several for points and colours; yes and no
/// are 1 and 0), or a word.
using Value = std::variant<std::vector<double>, std::string>;

} // namespace stromboli::api
