#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace stromboli::build {

/// Numbers in formats of plain text, which do not depend on the locale. Nothing if the whole word
/// is no such number.

/// A number with digits, point and exponent, and one sign at most, or nan, inf or infinity. One too
/// small for a double is 0, one too large is infinite.
std::optional<double> anyRealIn(std::string_view word);
/// A number as above that is finite.
std::optional<double> realIn(std::string_view word);
/// A finite number, or NaN for the words by which programs write what is no number or not finite:
/// nan, -nan(ind), inf, 1.#QNAN and the like.
std::optional<double> realOrNanIn(std::string_view word);
/// A number as above whose decimal point is written as a comma, as in some countries.
std::optional<double> realWithCommaIn(std::string_view word);
/// A whole number without a point, with one sign at most.
std::optional<int64_t> integerIn(std::string_view word);
/// A whole number below 2^32, without a sign.
std::optional<uint32_t> countIn(std::string_view word);

} // namespace stromboli::build
