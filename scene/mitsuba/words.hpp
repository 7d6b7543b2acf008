#pragma once

#include "scene/build/file_place.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <string_view>
#include <vector>

namespace stromboli::mitsuba {

/// What is between spaces and commas.
std::vector<std::string_view> wordsOf(std::string_view text);

/// Each throws SceneError at `where` for what is none; numbers are finite.
double numberOf(const build::FilePlace& where, std::string_view word);
int64_t integerOf(const build::FilePlace& where, std::string_view word);
bool flagOf(const build::FilePlace& where, std::string_view word);
std::vector<double> numbersOf(const build::FilePlace& where, std::string_view text);
/// Three numbers, or one for all three.
glm::dvec3 vectorOf(const build::FilePlace& where, std::string_view text);

} // namespace stromboli::mitsuba
