#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stromboli::reference {

// --- Random numbers ------------------------------------------------------------------------------

std::array<uint32_t, 4> philox(std::array<uint32_t, 4> c, std::array<uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
        const uint64_t a = uint64_t(0xD2511F53u) * c[0], b = uint64_t(0xCD9E8D57u) * c[2];
        c = {uint32_t(b >> 32) ^ c[1] ^ key[0], uint32_t(b), uint32_t(a >> 32) ^ c[3] ^ key[1],
             uint32_t(a)};
        key[0] += 0x9E3779B9u; // golden ratio
        key[1] += 0xBB67AE85u; // sqrt(3) - 1
    }
    return c;
}

namespace {

/// Two words as a fraction of 53 bits.
double fraction(uint32_t high, uint32_t low) {
    return double((uint64_t(high) << 32 | low) >> 11) * 0x1p-53;
}

/// The last word of a counter says what it is for.
constexpr uint32_t kFirstHalf = 0, kSecondHalf = 1, kKeys = 2, kMoreKeys = 3, kShuffle = 4;

uint64_t join(uint32_t high, uint32_t low) {
    return uint64_t(high) << 32 | low;
}

/// Samples of which one sequence has numbers; more of them begin another one.
constexpr uint32_t kIndexBits = 24;

/// What makes a block's points a sequence of their own.
struct SequenceKeys {
    std::array<uint64_t, 4> numbers; ///< by which digits are flipped
    uint64_t shuffle = 0;            ///< by which the points are put into another order
};

SequenceKeys makeSequenceKeys(uint32_t pixel, uint32_t sequence, uint32_t block, uint32_t seed) {
    const auto a = philox({block, sequence, pixel, kKeys}, {seed, 0});
    const auto b = philox({block, sequence, pixel, kMoreKeys}, {seed, 0});
    const auto c = philox({block, sequence, pixel, kShuffle}, {seed, 0});
    return {{join(a[0], a[1]), join(a[2], a[3]), join(b[0], b[1]), join(b[2], b[3])},
            join(c[0], c[1])};
}

/// makeSequenceKeys(), which all samples of a pixel ask for the same blocks: each thread remembers
/// those of the last pixel.
SequenceKeys sequenceKeys(uint32_t pixel, uint32_t sequence, uint32_t block, uint32_t seed) {
    struct Known {
        std::array<uint32_t, 4> of{0, 0, 0, 0};
        SequenceKeys keys;
        bool isSet = false;
    };
    constexpr uint32_t kBlocks = 64; // a path of many bounces takes that many
    thread_local std::array<Known, kBlocks> known;
    Known& k = known[block % kBlocks];
    const std::array<uint32_t, 4> of{pixel, sequence, block, seed};
    if (!k.isSet || k.of != of) k = {of, makeSequenceKeys(pixel, sequence, block, seed), true};
    return k.keys;
}

} // namespace

RandomStream::RandomStream(uint32_t pixel, uint32_t sample, uint32_t seed, Sampler sampler)
    : pixel_(pixel), sample_(sample), seed_(seed), sampler_(sampler) {}

void RandomStream::fill() {
    used_ = 0;
    const uint32_t block = block_++;
    if (sampler_ == Sampler::Independent) {
        const auto a = philox({block, sample_, pixel_, kFirstHalf}, {seed_, 0});
        const auto b = philox({block, sample_, pixel_, kSecondHalf}, {seed_, 0});
        digits_ = {a[0], a[2], b[0], b[2]};
        keys_ = {a[1], a[3], b[1], b[3]};
        return;
    }
    const SequenceKeys keys = sequenceKeys(pixel_, sample_ >> kIndexBits, block, seed_);
    digits_ = sobolPoint(owenShuffled(sample_ & ((1u << kIndexBits) - 1), keys.shuffle));
    keys_ = keys.numbers;
}

double RandomStream::next() {
    if (used_ == digits_.size()) fill();
    const unsigned i = used_++;
    return sampler_ == Sampler::Independent ? fraction(digits_[i], uint32_t(keys_[i]))
                                            : owenScrambled(digits_[i], keys_[i]);
}

void RandomStream::beginBlock() {
    used_ = unsigned(digits_.size());
}

glm::dvec3 RandomStream::threeNumbers() {
    beginBlock();
    const double x = next(), y = next(), z = next();
    return {x, y, z};
}

RandomStream RandomStream::apart() const {
    constexpr uint32_t kBlocksApart = 1u << 30;
    RandomStream stream(pixel_, sample_, seed_, Sampler::Independent);
    stream.block_ = block_ | kBlocksApart;
    return stream;
}

RandomStream RandomStream::branch(uint32_t number, uint32_t count) const {
    constexpr uint32_t kBranchBlocks = 1u << 31;
    RandomStream stream(pixel_, sample_ * count + number, seed_, sampler_);
    stream.block_ = block_ | kBranchBlocks;
    return stream;
}

// --- Sobol points --------------------------------------------------------------------------------

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

/// The points of indices that have no bits but those of one byte, by the byte's place and value:
/// any point is the exclusive or of four.
using PointsOfByte = std::array<std::array<uint32_t, kSobolDimensions>, 256>;
constexpr std::array<PointsOfByte, 4> pointsOfBytes() {
    std::array<PointsOfByte, 4> points{};
    for (size_t byte = 0; byte < points.size(); ++byte)
        for (size_t value = 0; value < points[byte].size(); ++value)
            for (size_t bit = 0; bit < 8; ++bit)
                for (size_t d = 0; d < kSobolDimensions; ++d)
                    if (value >> bit & 1) points[byte][value][d] ^= kColumns[d][8 * byte + bit];
    return points;
}
constexpr std::array<PointsOfByte, 4> kPointsOfBytes = pointsOfBytes();

/// Stafford's thirteenth mixing of 64 bits (2011), as in SplitMix64.
uint64_t mixed(uint64_t x) {
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

/// The hash of a key and the first `count` digits of a number, which are the only bits set in
/// `digits`.
uint64_t hashOfDigits(uint32_t digits, uint32_t count, uint64_t key) {
    return mixed(key + (uint64_t(digits) << 6 | count) * 0x9E3779B97F4A7C15u);
}

/// So many digits share a hash: of the 63 bits that they take, each belongs to one of the nodes of
/// the binary tree that their digits descend.
constexpr uint32_t kDigitsOfAHash = 6;

/// The flips of one group of digits, from the first bit on: `inGroup` digits that begin with digit
/// number `first`. The hash of those before them has one bit for each way in which the group can
/// begin.
template <uint32_t first, uint32_t inGroup>
uint32_t flipsOfGroup(uint32_t digits, uint64_t key) {
    uint32_t before = 0;
    if constexpr (first > 0) before = digits >> (32 - first) << (32 - first);
    const uint64_t hash = hashOfDigits(before, first, key);
    // Node 1 is the tree's root, the children of a node are 2 node and 2 node + 1. So the node of
    // the group's digit k is a one before the k digits above it.
    const uint32_t group = digits << first >> (32 - kDigitsOfAHash);
    uint32_t flips = 0;
    for (uint32_t k = 0; k < inGroup; ++k) {
        const uint32_t node = 1u << k | group >> (kDigitsOfAHash - k);
        flips |= uint32_t(hash >> node & 1) << (31 - k);
    }
    return flips >> first;
}

/// Flips digit k of a number, its bit 31 - k, by a bit that the digits 0 to k - 1 choose. Groups
/// depend on digits alone, not on flips of others, so that a processor works on all at once.
template <uint32_t count>
uint32_t flipped(uint32_t digits, uint64_t key) {
    constexpr uint32_t kGroup = kDigitsOfAHash, kWhole = count / kGroup;
    return [&]<uint32_t... group>(std::integer_sequence<uint32_t, group...>) {
        uint32_t flips = (0u | ... | flipsOfGroup<group * kGroup, kGroup>(digits, key));
        if constexpr (count % kGroup != 0)
            flips |= flipsOfGroup<kWhole * kGroup, count % kGroup>(digits, key);
        return digits ^ flips;
    }
    (std::make_integer_sequence<uint32_t, kWhole>{});
}

} // namespace

const SobolColumns& sobolColumns(size_t dimension) {
    return kColumns.at(dimension);
}

std::array<uint32_t, kSobolDimensions> sobolPoint(uint32_t index) {
    std::array<uint32_t, kSobolDimensions> point{};
    for (size_t byte = 0; byte < kPointsOfBytes.size(); ++byte) {
        const auto& part = kPointsOfBytes[byte][index >> 8 * byte & 0xFF];
        for (size_t d = 0; d < kSobolDimensions; ++d)
            point[d] ^= part[d];
    }
    return point;
}

double owenScrambled(uint32_t digits, uint64_t key) {
    const uint64_t rest = hashOfDigits(digits, 32, key) >> (64 - 21);
    return double(uint64_t(flipped<32>(digits, key)) << 21 | rest) * 0x1p-53;
}

uint32_t owenShuffled(uint32_t index, uint64_t key) {
    return flipped<24>(index << 8, key) >> 8;
}

// --- Warps ---------------------------------------------------------------------------------------

namespace {

/// The unit vector with azimuth 2 pi v whose angle to the z axis has this cosine and sine.
glm::dvec3 spherical(double cosine, double sine, double v) {
    return {sine * std::cos(2 * kPi * v), sine * std::sin(2 * kPi * v), cosine};
}

} // namespace

Frame::Frame(const glm::dvec3& axis) : z(axis) {
    // The coordinate axis least aligned with z keeps the cross product long.
    const glm::dvec3 a = glm::abs(z);
    const glm::dvec3 other = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                             : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                      : glm::dvec3(0, 0, 1);
    x = glm::normalize(glm::cross(other, z));
    y = glm::cross(z, x);
}

glm::dvec3 cosineHemisphere(double u, double v) {
    return spherical(std::sqrt(1 - u), std::sqrt(u), v);
}

glm::dvec3 uniformHemisphere(double u, double v) {
    return uniformCone(u, v, 1);
}

glm::dvec3 uniformSphere(double u, double v) {
    return uniformCone(u, v, 2);
}

glm::dvec3 uniformCone(double u, double v, double oneMinusCosMax) {
    const double oneMinusCos = u * oneMinusCosMax;
    const double sine2 = oneMinusCos * (2 - oneMinusCos);
    return spherical(1 - oneMinusCos, std::sqrt(std::max(sine2, 0.0)), v);
}

glm::dvec2 uniformTriangle(double u, double v) {
    // A point of the square beyond the diagonal is turned by half a turn about its middle.
    return u + v <= 1 ? glm::dvec2(u, v) : glm::dvec2(1 - u, 1 - v);
}

// --- Spherical triangles -------------------------------------------------------------------------

namespace {

/// Angle at unit `corner` between the great circles to p and to q.
double angleAt(const glm::dvec3& corner, const glm::dvec3& p, const glm::dvec3& q) {
    const glm::dvec3 m = glm::cross(corner, p), n = glm::cross(corner, q);
    return std::atan2(glm::length(glm::cross(m, n)), glm::dot(m, n));
}

/// The unit component of x that is orthogonal to unit y: Arvo's [x | y].
glm::dvec3 orthogonal(const glm::dvec3& x, const glm::dvec3& y) {
    const glm::dvec3 v = x - glm::dot(x, y) * y;
    const double length = glm::length(v);
    return length > 0 ? v / length : Frame(y).x;
}

} // namespace

SphericalTriangle::SphericalTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    : a_(a), b_(b), c_(c), alpha_(angleAt(a, b, c)) {
    area_ = std::max(alpha_ + angleAt(b, c, a) + angleAt(c, a, b) - kPi, 0.0); // Girard
}

glm::dvec3 SphericalTriangle::sample(double u, double v) const {
    const double cosAlpha = std::cos(alpha_), sinAlpha = std::sin(alpha_);
    const double s = std::sin(u * area_ - alpha_), t = std::cos(u * area_ - alpha_);
    const double x = t - cosAlpha, y = s + sinAlpha * glm::dot(a_, b_);
    const double q = ((y * t - x * s) * cosAlpha - y) / ((y * s + x * t) * sinAlpha);
    const double cosine = std::clamp(q, -1.0, 1.0);
    const glm::dvec3 swung = cosine * a_ + std::sqrt(1 - cosine * cosine) * orthogonal(c_, a_);
    const double z = 1 - v * (1 - glm::dot(swung, b_));
    return z * b_ + std::sqrt(std::max(1 - z * z, 0.0)) * orthogonal(swung, b_);
}

} // namespace stromboli::reference
