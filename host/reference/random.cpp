#include "host/reference/random.hpp"

#include "host/reference/sobol.hpp"

namespace stromboli::reference {

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

} // namespace

RandomStream::RandomStream(uint32_t pixel, uint32_t sample, uint32_t seed, Sampler sampler)
    : pixel_(pixel), sample_(sample), seed_(seed), sampler_(sampler) {}

void RandomStream::fill() {
    used_ = 0;
    const uint32_t block = block_++;
    if (sampler_ == Sampler::Independent) {
        const auto a = philox({block, sample_, pixel_, kFirstHalf}, {seed_, 0});
        const auto b = philox({block, sample_, pixel_, kSecondHalf}, {seed_, 0});
        numbers_ = {fraction(a[0], a[1]), fraction(a[2], a[3]), fraction(b[0], b[1]),
                    fraction(b[2], b[3])};
        return;
    }
    // The same for all samples of the pixel.
    const uint32_t sequence = sample_ >> kIndexBits;
    const auto a = philox({block, sequence, pixel_, kKeys}, {seed_, 0});
    const auto b = philox({block, sequence, pixel_, kMoreKeys}, {seed_, 0});
    const auto c = philox({block, sequence, pixel_, kShuffle}, {seed_, 0});
    const uint32_t index = owenShuffled(sample_ & ((1u << kIndexBits) - 1), join(c[0], c[1]));
    const auto point = sobolPoint(index);
    numbers_ = {
        owenScrambled(point[0], join(a[0], a[1])), owenScrambled(point[1], join(a[2], a[3])),
        owenScrambled(point[2], join(b[0], b[1])), owenScrambled(point[3], join(b[2], b[3]))};
}

double RandomStream::next() {
    if (used_ == numbers_.size()) fill();
    return numbers_[used_++];
}

void RandomStream::beginBlock() {
    used_ = unsigned(numbers_.size());
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

} // namespace stromboli::reference
