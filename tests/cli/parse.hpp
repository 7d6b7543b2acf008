#pragma once

#include "host/cli/options.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace stromboli::test {

/// A command that is to run. Throws UsageError as parseOptions does.
inline ParsedCommand parseAny(std::vector<std::string> arguments) {
    std::optional<ParsedCommand> command = parseOptions(std::move(arguments));
    if (!command) throw std::runtime_error("nothing to run");
    return std::move(*command);
}

/// The options of a command of which they are the kind.
template <class Options = RenderOptions>
Options parse(std::vector<std::string> arguments) {
    return std::get<Options>(parseAny(std::move(arguments)).options);
}

} // namespace stromboli::test
