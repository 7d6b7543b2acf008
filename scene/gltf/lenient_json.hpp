#pragma once

#include <string>
#include <string_view>

namespace stromboli::gltf {

/// JSON as it was meant, of a text that has what people and programs add to it by mistake:
/// comments, commas in front of a closing bracket, and numbers that are none (NaN,
/// Infinity, in any capitals), which become null. Lines stay where they are. Anything else stays as
/// it is, so that a text without these is the same.
std::string correctedJson(std::string_view text);

} // namespace stromboli::gltf
