// The only file that knows the library that splits the command line into options.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>

namespace stromboli {
namespace {

/// The words that followed each option that was given, by its name.
using Given = std::map<std::string, Words>;

/// With the default, as --help shows it.
std::string helpOf(const CommandOption& o) {
    return o.usual.empty() ? o.help : fmt::format("{} [{}]", o.help, o.usual);
}

void declare(CLI::App& app, const CommandOption& o, Given& given) {
    if (o.wordCount == 0) {
        app.add_flag_function(
               o.names, [&given, name = o.name()](std::int64_t) { given[name] = {}; }, o.help)
            ->group(o.isHidden ? "" : o.group);
        return;
    }
    CLI::Option* option = app.add_option(
        o.names,
        [&given, name = o.name()](const CLI::results_t& words) {
            given[name] = words;
            return true;
        },
        helpOf(o));
    option->group(o.isHidden ? "" : o.group);
    if (!o.valueNames.empty()) option->type_name(o.valueNames);
    if (o.isRequired) option->required();
    if (o.mayRepeat || o.separatedByCommas)
        option->type_size(1)->expected(1)->allow_extra_args(false)->multi_option_policy(
            CLI::MultiOptionPolicy::TakeAll);
    else if (o.anyNumber)
        option->type_size(1)->expected(-1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    else
        option->type_size(1)
            ->expected(int(o.wordCount))
            ->allow_extra_args(false)
            ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    if (o.separatedByCommas) option->delimiter(',');
}

void checkTogether(const CommandOption& o, const Given& given) {
    for (const CommandOption::Conflict& conflict : o.conflicts)
        if (given.count(conflict.option))
            throw UsageError(fmt::format("{} and {} exclude each other{}{}", o.name(),
                                         conflict.option, conflict.reason.empty() ? "" : ": ",
                                         conflict.reason));
    for (const std::string& other : o.needed)
        if (!given.count(other))
            throw UsageError(fmt::format("{} requires {} (see --help)", o.name(), other));
}

void store(const OptionList& list, const Given& given) {
    for (const CommandOption& o : list.all())
        if (given.count(o.name())) checkTogether(o, given);
    for (const bool first : {true, false})
        for (const CommandOption& o : list.all())
            if (const auto words = given.find(o.name()); words != given.end() && o.isFirst == first)
                o.store(words->second);
}

} // namespace

DeclaredCommand* parseCommand(std::deque<DeclaredCommand>& commands, Words arguments) {
    CLI::App app("Stromboli: a path tracer in Vulkan compute shaders.\n"
                 "COLLADA in, PNG or EXR out; on any Vulkan 1.1 device, GPU or not.",
                 "stromboli");
    app.set_version_flag("--version", std::string("stromboli ") + STROMBOLI_VERSION);
    app.require_subcommand(1);
    app.footer("'stromboli COMMAND --help' explains a command. Exit codes: 0 done, 1 usage, "
               "2 scene, 3 device (or a difference found), 4 output.");
    Given given;
    std::vector<CLI::App*> apps;
    for (const DeclaredCommand& c : commands) {
        CLI::App* one = apps.emplace_back(app.add_subcommand(c.name, c.description));
        if (!c.footer.empty()) one->footer(c.footer);
        for (const CommandOption& o : c.list.all())
            declare(*one, o, given);
    }
    try {
        std::reverse(arguments.begin(), arguments.end()); // CLI11 takes them from the back
        app.parse(arguments);
    } catch (const CLI::Success& done) { // --help, --version
        app.exit(done);
        return nullptr;
    } catch (const CLI::ParseError& error) {
        throw UsageError(std::string(error.what()) + " (see --help)");
    }
    const auto chosen =
        std::find_if(apps.begin(), apps.end(), [](const CLI::App* one) { return one->parsed(); });
    DeclaredCommand& command = commands[size_t(chosen - apps.begin())];
    store(command.list, given);
    command.finish();
    return &command;
}

} // namespace stromboli
