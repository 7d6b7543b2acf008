#pragma once

#include <string_view>

namespace stromboli {

/// The line at the bottom of a terminal that is redrawn in place and says what goes on. There is
/// none where standard error is no terminal, or one that cannot move its cursor (TERM=dumb), and
/// none before allow(). Every thread may draw; messages clear it before they appear
/// (setUpLogging).
namespace status_line {

/// Whether the user wants to see one.
void allow(bool wanted);
bool isShown();
/// Draws the text, cut to the width of the terminal, in place of what is there.
void draw(std::string_view text);
void clear();
/// What clear() writes: back to the first column, and the rest of the line is erased.
inline constexpr const char* kErase = "\r\033[K";

} // namespace status_line
} // namespace stromboli
