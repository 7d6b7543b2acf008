#pragma once

#include <string_view>

namespace stromboli::images {

/// Walks through the attributes of an OpenEXR file's headers before the library does. Each says how
/// many bytes its value has; the library allocates memory for that many before it reads them, and
/// goes by the value itself where it knows its type, so that both have to fit the file. Throws
/// std::runtime_error with what is wrong.
void checkExrAttributes(std::string_view bytes);

} // namespace stromboli::images
