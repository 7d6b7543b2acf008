#pragma once

#include <string>
#include <string_view>

namespace stromboli::mitsuba {

/// Names of Mitsuba 0.x, such as toWorld and intIOR, as later versions write them: to_world and
/// int_ior.
std::string upgradedName(std::string_view name);

/// The name that Mitsuba 0.4 has for a parameter of an object of 0.3 or earlier.
std::string ancientName(std::string_view tag, std::string_view type, std::string_view name);

/// A type of plugin of Mitsuba 0.x by its later name.
std::string upgradedType(std::string_view tag, std::string_view type);

/// By which plugins are known.
std::string inSmallLetters(std::string_view type);

} // namespace stromboli::mitsuba
