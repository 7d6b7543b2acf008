#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace stromboli::reference {

/// The first four dimensions of Sobol's sequence.
inline constexpr size_t kSobolDimensions = 4;

/// Columns of a dimension's generator matrix: the coordinate of point i is the exclusive or of
/// those columns whose bit of i is set; digit k of the coordinate is bit 31 - k.
using SobolColumns = std::array<uint32_t, 32>;
const SobolColumns& sobolColumns(size_t dimension);

/// Coordinates of point `index` < 2^32, in units of 2^-32.
std::array<uint32_t, kSobolDimensions> sobolPoint(uint32_t index);

/// Owen's nested uniform scrambling (1995) of a 32-bit fraction, from its definition: each digit is
/// flipped or not by a bit of its own for each value of the digits before it, from hashes of them
/// and the key. In [0, 1), a multiple of 2^-53: what follows the 32 digits is the hash of all of
/// them.
double owenScrambled(uint32_t digits, uint64_t key);

/// The same permutation of the numbers below 2^24 by their digits: 2^k of them that begin at a
/// multiple of 2^k stay such a set.
uint32_t owenShuffled(uint32_t index, uint64_t key);

} // namespace stromboli::reference
