#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace stromboli {

__extension__ using uint128 = unsigned __int128;

/// A multiple of 2^lowest, in two's complement: of absolute value below half of
/// 2^(lowest + 64 * wordCount). Sums of such numbers are exact, so that they depend neither on
/// their order nor on their grouping. What does not fit wraps around: callers keep to the range.
template <size_t wordCount, int lowest>
class FixedSum {
  public:
    static constexpr int kLowest = lowest;
    /// The least power of two that is too large is 2^kLimit.
    static constexpr int kLimit = lowest + 64 * int(wordCount) - 1;

    /// Adds a finite number; what its absolute value has below 2^lowest is left out.
    void add(double value) {
        if (std::signbit(value)) {
            FixedSum positive;
            positive.add(-value);
            add(positive.negated());
            return;
        }
        constexpr int kBias = 1075; // of the exponent of a double's 53 digits as a whole number
        const auto bits = std::bit_cast<uint64_t>(value);
        const int exponent = int(bits >> 52);
        const uint64_t digits = bits & ((uint64_t(1) << 52) - 1);
        if (exponent == 0)
            add(digits, 1 - kBias); // subnormal
        else
            add(digits | uint64_t(1) << 52, exponent - kBias);
    }
    /// Adds digits * 2^exponent; what that has below 2^lowest is left out.
    void add(uint128 digits, int exponent) {
        int shift = exponent - lowest;
        if (shift <= -128) return;
        if (shift < 0) digits >>= -shift, shift = 0;
        const auto low = uint64_t(digits), high = uint64_t(digits >> 64);
        const size_t word = size_t(shift) / 64;
        const int bits = shift % 64;
        addWord(word, low << bits);
        addWord(word + 1, bits == 0 ? high : high << bits | low >> (64 - bits));
        if (bits != 0) addWord(word + 2, high >> (64 - bits));
    }
    void add(const FixedSum& other) {
        uint128 carry = 0;
        for (size_t i = 0; i < wordCount; ++i) {
            carry += uint128(words[i]) + other.words[i];
            words[i] = uint64_t(carry);
            carry >>= 64;
        }
    }
    bool isNegative() const { return words[wordCount - 1] >> 63 != 0; }
    FixedSum negated() const {
        FixedSum result;
        uint64_t carry = 1;
        for (size_t i = 0; i < wordCount; ++i) {
            result.words[i] = ~words[i] + carry;
            carry = carry != 0 && result.words[i] == 0 ? 1 : 0;
        }
        return result;
    }
    FixedSum magnitude() const { return isNegative() ? negated() : *this; }
    /// What is left when `other` is taken away; 0 if that is more. Both are not negative, as sums
    /// of squares are: of other numbers, add what is negated.
    FixedSum less(const FixedSum& other) const {
        FixedSum result;
        uint64_t borrow = 0;
        for (size_t i = 0; i < wordCount; ++i) {
            const uint128 taken = uint128(other.words[i]) + borrow;
            result.words[i] = uint64_t(words[i] - taken);
            borrow = words[i] < taken ? 1 : 0;
        }
        return borrow ? FixedSum{} : result;
    }

    /// The nearest double.
    double value() const {
        if (isNegative()) return -negated().value();
        const Top t = top();
        // A last bit for all that follows: 64 bits are more than the rounding to 53 looks at.
        return std::ldexp(double(t.digits | (t.isExact ? 0 : 1)), t.exponent);
    }
    /// The first 64 binary digits of a number that is not negative: digits * 2^exponent is it, or
    /// just below it.
    struct Top {
        uint64_t digits = 0;
        int exponent = 0;
        bool isExact = true;
    };
    Top top() const {
        size_t i = wordCount;
        while (i > 0 && words[i - 1] == 0)
            --i;
        if (i == 0) return {};
        const int zeros = std::countl_zero(words[i - 1]);
        Top t{words[i - 1] << zeros, lowest + 64 * int(i - 1) - zeros, true};
        if (i == 1) return t;
        const uint64_t below = words[i - 2];
        if (zeros > 0) t.digits |= below >> (64 - zeros);
        uint64_t rest = below << zeros;
        for (size_t k = 0; k + 2 < i; ++k)
            rest |= words[k];
        t.isExact = rest == 0;
        return t;
    }

    std::array<uint64_t, wordCount> words{}; ///< the least significant first

    bool operator==(const FixedSum&) const = default;

  private:
    void addWord(size_t i, uint64_t word) {
        for (; i < wordCount && word != 0; ++i) {
            words[i] += word;
            word = words[i] < word ? 1 : 0; // carried on
        }
    }
};

} // namespace stromboli
