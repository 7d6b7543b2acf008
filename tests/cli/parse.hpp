#pragma once

#include "host/cli/options.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace stromboli::test {

/// The options of a command that is to run. Throws UsageError as parseOptions does.
inline Options parse(std::vector<std::string> arguments) {
    const std::optional<Options> options = parseOptions(std::move(arguments));
    if (!options) throw std::runtime_error("nothing to run");
    return *options;
}

} // namespace stromboli::test
