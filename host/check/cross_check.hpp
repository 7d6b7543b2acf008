#pragma once

#include "host/film/film.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace stromboli {

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
    double relativeDifference = 0; ///< (meanA - meanB) / the mean of both; 0 for black
    double z = 0;
    bool isBlack = false; ///< in both films
    /// The smallest relativeDifference of the whole picture that the test of the means finds with
    /// probability CheckSettings::power; infinite: it finds none.
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
///    few dozen samples only an error in one of the films explains a difference.
/// familyError is divided equally among 1, 2 and 4, with Sidak's correction within each.
/// Throws std::invalid_argument if the films have different sizes.
CheckResult crossCheck(const Film& a, const Film& b, const CheckSettings& settings = {});

/// A report of a few lines, the verdict last.
std::string formatCheck(const CheckResult& result);

} // namespace stromboli
