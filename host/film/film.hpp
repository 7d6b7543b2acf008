#pragma once

#include <glm/glm.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stromboli {

// --- The pixels of a picture ---------------------------------------------------------------------

/// A part of a picture, in pixels from the top left corner of the whole.
struct Crop {
    uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// A pixel of the whole picture: column, row from the top.
struct PixelPlace {
    uint32_t x = 0, y = 0;
};

/// Which pixels a picture has and which of them are rendered.
struct PictureArea {
    uint32_t width = 800, height = 600; ///< of the whole picture, before the crop
    Crop crop;                          ///< width 0: the whole picture

    /// What is rendered: the crop, or the whole picture where there is none.
    Crop rendered() const { return crop.width == 0 ? Crop{0, 0, width, height} : crop; }
    /// Column and row, in the whole picture, of a pixel that is rendered: `index` counts these row
    /// by row.
    PixelPlace placeOf(uint32_t index) const {
        const Crop part = rendered();
        return {part.x + index % part.width, part.y + index / part.width};
    }
    /// The number of pixels that are rendered.
    uint64_t pixelCount() const {
        const Crop part = rendered();
        return uint64_t(part.width) * part.height;
    }
};

/// Whether the same pixels of a picture of the same size are rendered.
inline bool sameArea(const PictureArea& a, const PictureArea& b) {
    const Crop x = a.rendered(), y = b.rendered();
    return a.width == b.width && a.height == b.height && x.x == y.x && x.y == y.y &&
           x.width == y.width && x.height == y.height;
}

// --- Films ---------------------------------------------------------------------------------------

/// Running statistics of one pixel's samples (linear RGB radiance).
struct PixelStatistics {
    uint32_t count = 0;                   ///< samples in the mean; rejected ones are not
    uint32_t rejected = 0;                ///< samples whose radiance was not finite or negative
    uint32_t firstRejected = 0xFFFFFFFFu; ///< index of the first rejected sample
    glm::dvec3 mean{0.0};
    glm::dvec3 m2{0.0}; ///< sum of squared deviations from the mean (Welford 1962)

    uint32_t taken() const { return count + rejected; }
    /// Unbiased variance of one sample, per channel; 0 for fewer than two samples.
    glm::dvec3 variance() const;
    /// Variance of the mean.
    glm::dvec3 varianceOfMean() const;
    /// Adds one sample; rejects it if a channel is not finite or is negative. weight: that of its
    /// place by a pixel filter, which may be negative.
    void add(const glm::dvec3& radiance, double weight = 1);
    /// Chan, Golub and LeVeque 1979: statistics of the union of two sets of samples. The other's
    /// samples follow these: its firstRejected counts from its own first sample.
    void merge(const PixelStatistics& other);
    /// Likewise, of a pixel's samples that were dealt to `strands` one by one: the other has those
    /// of this strand.
    void mergeStrand(const PixelStatistics& other, uint32_t strand, uint32_t strands);
};

/// The part of a picture that is rendered, in the making: row 0 is the top, pixel (x, y) of the
/// part is pixels[y * width + x].
struct Film {
    uint32_t width = 0, height = 0; ///< of the part
    PictureArea area;               ///< where the part lies in the whole picture
    std::vector<PixelStatistics> pixels;
    uint32_t branches = 1; ///< paths of a sample (docs/theory/estimator.md, "Branches")

    Film() = default;
    explicit Film(const PictureArea& a)
        : width(a.rendered().width), height(a.rendered().height), area(a), pixels(a.pixelCount()) {}
    /// A whole picture.
    Film(uint32_t w, uint32_t h) : Film(PictureArea{w, h, {}}) {}
    PixelStatistics& at(uint32_t x, uint32_t y) { return pixels[size_t(y) * width + x]; }
    const PixelStatistics& at(uint32_t x, uint32_t y) const {
        return pixels[size_t(y) * width + x];
    }
};

// --- Statistics that add up exactly --------------------------------------------------------------

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

/// Statistics of a pixel's samples that can be put together from blocks of them in any order and
/// grouping, to the same bits. A block's own statistics are rounded when it is added; from then on
/// sums are exact, and mean and variance are worked out once, when they are asked for
/// (docs/guide/farm.md, "How sums become exact").
struct ExactStatistics {
    /// A sum of radiance. A film's samples are at most 2^48 each, negative where a pixel filter is,
    /// and there are at most 2^24.
    using Sum = FixedSum<4, -180>;
    /// A sum of squared radiance.
    using Squares = FixedSum<5, -192>;

    uint32_t count = 0, rejected = 0;
    uint32_t firstRejected = 0xFFFFFFFFu; ///< counted from the pixel's first sample
    std::array<Sum, 3> sum;               ///< of the samples
    /// The sum over all blocks of their squared deviations from their means, and of their squared
    /// sums divided by their counts.
    std::array<Squares, 3> squares;

    uint32_t taken() const { return count + rejected; }
    /// Adds a block of samples, the first of which is the pixel's sample `firstSample`. Throws
    /// SceneError if their radiance is out of range.
    void add(const PixelStatistics& block, uint32_t firstSample);
    void add(const ExactStatistics& other);
    /// The statistics of all samples. If a single block was added, they are what was added.
    PixelStatistics statistics() const;

    bool operator==(const ExactStatistics&) const = default;
};

/// A pixel of a film that several machines fill: of all its samples, and how much of them the last
/// pass over it took, which says how large the error is that is left (docs/theory/noise.md, "How
/// noisy a picture is"). Can be put together in any order and grouping, to the same bits.
struct SharedPixel {
    ExactStatistics all;
    /// How many of the samples taken have a camera ray that ends on a surface, if the picture has
    /// alpha.
    uint32_t covered = 0;
    /// The number of the latest pass among the samples in the mean, and the samples that it added.
    uint32_t lastPass = 0, lastCount = 0;
    std::array<ExactStatistics::Sum, 3> lastSum;

    /// Adds samples that pass number `pass` took, the first of which is the pixel's sample
    /// `firstSample`. Throws SceneError if their radiance is out of range.
    void add(const PixelStatistics& samples, uint32_t firstSample, uint32_t pass);
    void add(const SharedPixel& other);
    /// Adds a pixel whose samples are all of its last pass; `other` need not know more of that pass
    /// than its number.
    void addOfOnePass(const SharedPixel& other);
    /// The share of its samples that a surface covers.
    float alpha() const { return all.taken() > 0 ? float(double(covered) / all.taken()) : 0.0f; }
    /// Whether no pass was before the last one.
    bool isOfOnePass() const { return lastCount == all.count && lastSum == all.sum; }
    /// An estimate of the squared error of the mean: from what the last pass changed or, where it
    /// is the only one, from the variance of the samples (NoiseEstimate).
    glm::dvec3 squaredError() const;

    bool operator==(const SharedPixel&) const = default;

  private:
    void addToLast(uint32_t pass, uint32_t count, const std::array<ExactStatistics::Sum, 3>& sum);
};

} // namespace stromboli
