#pragma once

#include <string_view>

namespace stromboli {

// What a film begins and ends with.

/// Changes with every change of what is written.
inline constexpr std::string_view kFilmMagic = "stromboli film 4\n";
/// Not there in what is cut short.
inline constexpr std::string_view kFilmEnd = "end of film\n";

} // namespace stromboli
