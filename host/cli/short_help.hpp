#pragma once

#include <string>

namespace stromboli {

/// What the program says when it is called without arguments: enough to make a picture.
std::string shortHelp();

} // namespace stromboli
