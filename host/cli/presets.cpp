#include "host/cli/presets.hpp"

#include "host/cli/command_line.hpp"
#include "host/core/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace stromboli {
namespace {

struct Setting {
    Preset preset;
    const char* option;
    const char* word;
};
constexpr Setting kSettings[] = {
    {Preset::Product, "--env", "studio"},
    {Preset::Product, "--exposure", "auto"},
    {Preset::Product, "--view", "pbr-neutral"},
    {Preset::Product, "--denoise", "on"},
    {Preset::Interior, "-m", "16"},
    {Preset::Interior, "--exposure", "auto"},
    {Preset::Interior, "--view", "agx"},
    {Preset::Interior, "--denoise", "on"},
    {Preset::Exterior, "--sun", "135,40"},
    {Preset::Exterior, "--exposure", "auto"},
    {Preset::Exterior, "--view", "agx"},
    {Preset::Exterior, "--denoise", "on"},
    {Preset::Draft, "-s", "8"},
    {Preset::Draft, "-m", "4"},
    {Preset::Draft, "--denoise", "on"},
    {Preset::Final, "--noise", "1%"},
    {Preset::Final, "-s", "16384"},
};

/// Options that say when a render ends: where one is given, the others are not set.
const Words kBudgets = {"-s", "--noise", "--time", "-a", "--even"};

const CommandOption* optionOf(const OptionList& list, const std::string& name) {
    const auto found =
        std::ranges::find_if(list.all(), [&](const CommandOption& o) { return o.name() == name; });
    return found == list.all().end() ? nullptr : &*found;
}

bool excludes(const CommandOption& one, const std::string& other) {
    return std::ranges::find(one.conflicts, other, &CommandOption::Conflict::option) !=
           one.conflicts.end();
}

/// Whether the option is given, or one that does not go with it.
bool isDecided(const OptionList& list, const CommandOption& option,
               const std::map<std::string, Words>& given) {
    const bool isBudget = std::ranges::count(kBudgets, option.name()) > 0;
    return std::ranges::any_of(given, [&](const auto& one) {
        const CommandOption* other = optionOf(list, one.first);
        return one.first == option.name() || excludes(option, one.first) ||
               (other && excludes(*other, option.name())) ||
               (isBudget && std::ranges::count(kBudgets, one.first) > 0);
    });
}

/// Radiance as it is has no exposure and no curve, and shares of a picture are not denoised.
bool isOfWholePictures(const std::string& option) {
    return option == "--view" || option == "--exposure" || option == "--denoise";
}

bool writesRadiance(const std::map<std::string, Words>& given) {
    const auto output = given.find("-o");
    return output != given.end() && !output->second.empty() &&
           output->second.front().ends_with(".exr");
}

} // namespace

void declarePreset(OptionList& list) {
    list.group("Picture");
    std::string sets;
    for (const NamedValue<Preset>& row : kNamedValues<Preset>) {
        Words options;
        for (const Setting& setting : kSettings)
            if (setting.preset == row.value)
                options.push_back(fmt::format("{} {}", setting.option, setting.word));
        sets += fmt::format("{}{}: {}: {}", sets.empty() ? "" : "; ", row.name, row.meaning,
                            fmt::join(options, " "));
    }
    list.words("--preset", "NAME",
               "sets other options that are not given themselves, and says which (" + sets + ")", 1,
               [](const Words& words) {
                   if (!valueNamed<Preset>(words[0]))
                       refuseName("--preset", words[0], namesOf<Preset>(), allNames<Preset>());
               })
        .proposes(namesOf<Preset>());
}

std::string addPreset(const OptionList& list, std::map<std::string, Words>& given) {
    const auto named = given.find("--preset");
    if (named == given.end() || named->second.empty()) return {};
    const std::string name = named->second.front();
    const std::optional<Preset> preset = valueNamed<Preset>(name);
    if (!preset) return {}; // refused when it is stored
    const std::map<std::string, Words> asked = given;
    Words added;
    for (const Setting& setting : kSettings) {
        const CommandOption* option = optionOf(list, setting.option);
        const bool isUseless =
            isOfWholePictures(setting.option) &&
            (asked.contains("--share") ||
             (std::string_view(setting.option) != "--denoise" && writesRadiance(asked)));
        if (setting.preset != *preset || !option || isDecided(list, *option, asked) || isUseless)
            continue;
        given.emplace(setting.option, Words{setting.word});
        added.push_back(fmt::format("{} {}", setting.option, setting.word));
    }
    return fmt::format("--preset {} sets {}", name,
                       added.empty() ? "nothing that is not given"
                                     : fmt::format("{}", fmt::join(added, " ")));
}

} // namespace stromboli
