#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli::spirv {

/// A module in which `constants[i]` has taken the place of specialisation constant i (bool as 0 or
/// 1; constants beyond the span keep their defaults), and from which all that this makes
/// superfluous is gone: branches that are never taken, values that nobody reads, variables that are
/// never loaded, members of structures that nobody asks for, types, bindings and names that nobody
/// uses. What is left is straightened, which spares drivers rounds of their passes: early returns
/// become nested selections, counted loops are unrolled, and what was stored is not loaded again.
///
/// Integers and booleans are computed, floating-point operations are left as they are and in their
/// order, so that a driver makes the same arithmetic of the result as of the module and its
/// constants. Numbers are given in the order of first use: two modules that differ in code that the
/// constants switch off have the same words afterwards.
///
/// Nothing where the module has an instruction that the grammar does not know, or no single entry
/// point: such a module goes to the driver as it is.
std::optional<std::vector<uint32_t>> specialise(std::span<const uint32_t> module,
                                                std::span<const uint32_t> constants);

} // namespace stromboli::spirv
