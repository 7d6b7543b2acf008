#pragma once

#include <cstdint>

namespace stromboli {

/// Probability that a standard normal variable is beyond z on either side.
double twoSidedProbability(double z);

/// The z >= 0 that a standard normal variable exceeds, on either side, with this probability in
/// (0, 1].
double twoSidedQuantile(double probability);

/// Level of each of `tests` independent tests whose family has the error `familyError`
/// (Sidak 1967): 1 - (1 - familyError)^(1 / tests).
double sidakLevel(double familyError, uint64_t tests);

} // namespace stromboli
