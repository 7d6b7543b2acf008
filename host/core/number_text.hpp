#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace stromboli {

/// Numbers as users write them: decimal digits, with a point, an exponent, and k or M for thousands
/// and millions, as in "12", "0.05", "2.5k", "1e6", "4M". Nothing else: no spaces, no NaN, no
/// infinity. Empty if the whole text is no such number, or is one that the type cannot hold.

/// A number without a fraction, exactly: "2.5k" is 2500, "1.5" is none.
std::optional<uint64_t> wholeNumber(std::string_view text);
/// The double nearest to the number; empty too where that would be 0 for a number that is not.
std::optional<double> realNumber(std::string_view text);

} // namespace stromboli
