#pragma once

#include <string>
#include <string_view>

namespace stromboli {

/// Text from elsewhere (names in files, names of files) as it may be shown: control characters and
/// bytes that are no UTF-8 become \n, \t or \x1b and the like, so that a file can neither break a
/// message into lines nor give orders to a terminal.
std::string printable(std::string_view text);

} // namespace stromboli
