#include "host/reference/random.hpp"

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

RandomStream::RandomStream(uint32_t pixel, uint32_t sample, uint32_t seed)
    : key_{seed, 0}, counter_{0, sample, pixel, 0} {}

double RandomStream::next() {
    if (used_ == words_.size()) {
        words_ = philox(counter_, key_);
        ++counter_[0];
        used_ = 0;
    }
    const uint64_t high = words_[used_], low = words_[used_ + 1];
    used_ += 2;
    return double((high << 32 | low) >> 11) * 0x1p-53;
}

} // namespace stromboli::reference
