#include "host/cli/options.hpp"

#include "host/cli/cs184_spelling.hpp"
#include "host/cli/declared_command.hpp"

namespace stromboli {

std::optional<Options> parseOptions(std::vector<std::string> arguments) {
    std::deque<DeclaredCommand> commands = declareCommands();
    const DeclaredCommand* const chosen =
        parseCommand(commands, fromCs184Spelling(std::move(arguments)));
    if (!chosen) return std::nullopt;
    return chosen->options;
}

} // namespace stromboli
