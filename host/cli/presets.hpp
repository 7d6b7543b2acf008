#pragma once

#include "host/cli/declared_command.hpp"

#include <map>
#include <string>

namespace stromboli {

/// A name for options that are often wanted together.
enum class Preset { Product, Interior, Exterior, Draft, Final };
template <>
inline constexpr auto kNamedValues<Preset> = std::to_array<NamedValue<Preset>>({
    {Preset::Product, "product", "a model in a studio"},
    {Preset::Interior, "interior", "a room, with light that is reflected often"},
    {Preset::Exterior, "exterior", "under a sun"},
    {Preset::Draft, "draft", "a first look in seconds"},
    {Preset::Final, "final", "until its noise is 1 %"},
});

void declarePreset(OptionList& list);

/// Adds to the options that are given (by name, with their words) those that the preset among them
/// sets, but for those that are given, that exclude one of these, or that a file to write has no
/// use for. Returns a line that says which were added; empty: there is no preset.
std::string addPreset(const OptionList& list, std::map<std::string, Words>& given);

} // namespace stromboli
