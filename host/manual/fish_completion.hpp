#pragma once

#include <string>

namespace stromboli {

/// The same for fish, which also shows what each option means.
std::string fishCompletion();

} // namespace stromboli
