#include "host/reference/sobol.hpp"

#include <algorithm>

namespace stromboli::reference {
namespace {

/// A primitive polynomial over GF(2) and the first numbers m_k of its dimension: Joe and Kuo,
/// "Constructing Sobol Sequences with Better Two-Dimensional Projections" (2008), table
/// new-joe-kuo-6.
struct Primitive {
    uint32_t degree, inner; ///< inner: coefficients between the first and the last
    std::array<uint32_t, 3> m;
};
constexpr Primitive kPrimitives[] = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}};

/// Their recurrence (equation 2): m_k = 2 a_1 m_{k-1} ^ ... ^ 2^s m_{k-s} ^ m_{k-s}.
constexpr SobolColumns columnsOf(const Primitive& p) {
    std::array<uint32_t, 32> m{};
    for (uint32_t k = 0; k < 32; ++k) {
        if (k < p.degree) {
            m[k] = p.m[k];
            continue;
        }
        m[k] = m[k - p.degree] ^ m[k - p.degree] << p.degree;
        for (uint32_t i = 1; i < p.degree; ++i)
            if (p.inner >> (p.degree - 1 - i) & 1) m[k] ^= m[k - i] << i;
    }
    for (uint32_t k = 0; k < 32; ++k)
        m[k] <<= 31 - k;
    return m;
}

constexpr SobolColumns vanDerCorput() {
    SobolColumns columns{};
    for (uint32_t k = 0; k < 32; ++k)
        columns[k] = 0x80000000u >> k;
    return columns;
}

constexpr std::array<SobolColumns, kSobolDimensions> kColumns = {
    vanDerCorput(), columnsOf(kPrimitives[0]), columnsOf(kPrimitives[1]),
    columnsOf(kPrimitives[2])};

/// Stafford's thirteenth mixing of 64 bits (2011), as in SplitMix64.
uint64_t mixed(uint64_t x) {
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

/// Of a key and the first `count` digits of a number, which are the only bits set in `digits`.
uint64_t hashOfDigits(uint32_t digits, uint32_t count, uint64_t key) {
    return mixed(key + (uint64_t(digits) << 6 | count) * 0x9E3779B97F4A7C15u);
}

/// So many digits share a hash: of the 63 bits that they take, each belongs to one of the nodes of
/// the binary tree that their digits descend.
constexpr uint32_t kDigitsOfAHash = 6;

/// Flips digit k of a number, its bit 31 - k, by a bit that the digits 0 to k - 1 choose: the hash
/// of those before its group has one bit for each way in which the group can begin.
uint32_t flipped(uint32_t digits, uint32_t count, uint64_t key) {
    uint32_t result = digits;
    for (uint32_t first = 0; first < count; first += kDigitsOfAHash) {
        const uint32_t before = first == 0 ? 0 : digits >> (32 - first) << (32 - first);
        const uint64_t flips = hashOfDigits(before, first, key);
        uint32_t node = 1; // the root; its children are 2 node and 2 node + 1
        for (uint32_t k = first; k < std::min(first + kDigitsOfAHash, count); ++k) {
            result ^= uint32_t(flips >> node & 1) << (31 - k);
            node = 2 * node + (digits >> (31 - k) & 1);
        }
    }
    return result;
}

} // namespace

const SobolColumns& sobolColumns(size_t dimension) {
    return kColumns.at(dimension);
}

std::array<uint32_t, kSobolDimensions> sobolPoint(uint32_t index) {
    std::array<uint32_t, kSobolDimensions> point{};
    for (uint32_t k = 0; k < 32 && index >> k; ++k)
        for (size_t d = 0; d < kSobolDimensions; ++d)
            point[d] ^= kColumns[d][k] & (0u - (index >> k & 1)); // no branch: it would be a coin
    return point;
}

double owenScrambled(uint32_t digits, uint64_t key) {
    const uint64_t rest = hashOfDigits(digits, 32, key) >> (64 - 21);
    return double(uint64_t(flipped(digits, 32, key)) << 21 | rest) * 0x1p-53;
}

uint32_t owenShuffled(uint32_t index, uint64_t key) {
    return flipped(index << 8, 24, key) >> 8;
}

} // namespace stromboli::reference
