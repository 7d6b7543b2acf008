#pragma once

#include <string>

namespace stromboli {

/// The same for zsh, which also shows what each option and its words mean.
std::string zshCompletion();

} // namespace stromboli
