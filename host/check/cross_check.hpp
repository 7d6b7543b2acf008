#pragma once

#include "host/film/film.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace stromboli {

/// Probability that a standard normal variable is beyond z on either side.
double twoSidedProbability(double z);

/// The z >= 0 that a standard normal variable exceeds, on either side, with this probability in
/// (0, 1].
double twoSidedQuantile(double probability);

/// Level of each of `tests` independent tests whose family has the error `familyError`
/// (Sidak 1967): 1 - (1 - familyError)^(1 / tests).
double sidakLevel(double familyError, uint64_t tests);

/// Radiance that float arithmetic may turn into 0: a factor below 2^-126 vanishes, and may have
/// been about to be multiplied by up to 2^26 (radiance, areas, densities).
inline constexpr double kUnderflow = 0x1p-100;

/// Sum over pixels of the difference of two films' means in one channel, with its variance.
///
/// The variance is the one that holds if the films agree. Two estimates of it are kept and the
/// larger one is used:
/// - separate: each film's own variance. Right whatever the two sample counts and whether or not
///   single samples of both films have the same distribution.
/// - pooled: both films' samples as one set, as in a permutation test. Right for rare bright
/// samples
///   that one film happens to have and the other has not, where the separate one is too small.
/// Either contains the difference itself, so that a pixel of n samples in each film never has
/// |z| > sqrt(2 n - 1): few samples prove little, however equal they are.
class Difference {
  public:
    /// Both pixels have at least one sample.
    void add(const PixelStatistics& a, const PixelStatistics& b, int channel);
    void add(const Difference& other);

    double sumA() const { return sumA_; }
    double sumB() const { return sumB_; }
    /// Difference of the sums, A - B, moved towards 0 by what rounding to float may explain, in
    /// standard deviations. `rounding`: relative error of each film's values.
    double z(double rounding) const;
    /// How much brighter or darker one film has to be throughout, relative to the mean of both, for
    /// |z| to exceed `limit` with probability `power` (> 1/2), as far as the variance found here is
    /// the true one. Infinite where no difference would do: black pictures, and too few samples.
    double visible(double limit, double power, double rounding) const;
    /// Neither film has radiance that a float could hold.
    bool isBlack() const { return std::max(sumA_, sumB_) <= kUnderflow; }

  private:
    double variance() const { return std::max(separate_, pooled_); }

    double sumA_ = 0, sumB_ = 0, separate_ = 0, pooled_ = 0;
    /// What a relative difference of 1 in every pixel adds to either variance: each contains the
    /// pixel's squared difference / (n - 1).
    double ownShare_ = 0;
};

/// How two films are compared.
struct CheckSettings {
    /// Probability that two films of the same picture are called different.
    double familyError = 1e-3;
    /// Side of the smallest blocks, in pixels; blocks of twice, four times, ... the side follow.
    uint32_t blockSize = 8;
    /// Share of the pixels that must pass their own test.
    double requiredFraction = 0.9975;
    /// Relative error that arithmetic may put on a film's values. The kernel's float arithmetic
    /// gives a sample as a sum of products of some tens of operations, each good to 2^-24 to
    /// 2^-22; this allows 256 roundings.
    double rounding = 0x1p-16;
    /// Probability of finding the differences that CheckChannel::visible states.
    double power = 0.95;
};

/// A block of pixels and how far apart two films are in it.
struct CheckBlock {
    uint32_t x = 0, y = 0, width = 0, height = 0;
    int channel = 0;
    double z = 0; ///< difference of the means, A - B, in standard deviations
};

/// One channel of the whole picture.
struct CheckChannel {
    double meanA = 0, meanB = 0;
    double relativeDifference = 0; ///< (meanA - meanB) / meanB; 0 for equal means
    double z = 0;
    bool isBlack = false; ///< in both films
    /// The smallest difference of the means, over the mean of both, that the test of the means
    /// finds with probability CheckSettings::power; infinite: it finds none.
    double visible = 0;
};

/// A comparison that finds no difference says something only if it could have found one.
enum class Verdict {
    Agree,
    Different,
    Undecided ///< no difference was found, but none could have been
};

/// What a comparison found.
struct CheckResult {
    uint64_t pixels = 0;     ///< with samples in both films
    uint64_t varied = 0;     ///< of them, with two samples in one film: the least that varies
    double power = 0;        ///< of CheckChannel::visible
    uint64_t blockTests = 0; ///< blocks of all sizes times channels
    std::array<CheckChannel, 3> channels;
    double channelLimit = 0; ///< on |CheckChannel::z|
    CheckBlock worstBlock;
    double blockLimit = 0;      ///< on |CheckBlock::z|
    CheckBlock worstPixel;      ///< a block of one pixel
    double pixelLimit = 0;      ///< on a pixel's |z|: at the Sidak level of all pixels together
    double fractionPassing = 0; ///< of the pixels, in all three channels
    uint64_t constantMismatches = 0; ///< pixels without variance that differ: see crossCheck()
    uint64_t rejectedA = 0, rejectedB = 0; ///< samples that were not finite, for information

    bool channelsAgree = false, blocksAgree = false, pixelsAgree = false, constantsAgree = false;

    bool anyDiffers() const {
        return !(channelsAgree && blocksAgree && pixelsAgree && constantsAgree);
    }
    /// Whether some channel is not black and would have told a black picture (a relative difference
    /// of 2) from one that is not; or all channels are black.
    bool couldSee() const;
    Verdict verdict() const;
    bool agree() const { return verdict() == Verdict::Agree; }
};

/// Tests the hypothesis that two films, made with independent random numbers and without adaptive
/// sampling, are estimates of the same picture:
/// 1. the means of each channel over the picture,
/// 2. the means over blocks of all sizes from blockSize up (Monte Carlo samples are far from
///    normal; sums over a block's samples are much closer, and normalised by a variance that
///    contains the same bright samples, as class Difference does, they err on the safe side),
/// 3. the share of pixels that pass their own test, which finds many wrong pixels whose errors
///    cancel,
/// 4. pixels whose samples are all equal within each film must be equal between the films up to
///    rounding: a pixel where a sample has the value with probability p is all-equal in film A
///    and all-unlike it in film B with probability p^na (1 - p)^nb <= 2^-2min(na, nb), so beyond a
///    few dozen samples only an error in one of the films explains a difference. Means below 2^-47
///    are left out: a film's squares of so small deviations underflow.
/// familyError is divided equally among 1, 2 and 4, with Sidak's correction within each.
/// Throws std::invalid_argument if the films have different sizes.
CheckResult crossCheck(const Film& a, const Film& b, const CheckSettings& settings = {});

/// A report of a few lines, the verdict last.
std::string formatCheck(const CheckResult& result);

} // namespace stromboli
