#include "host/compare/comparison.hpp"

#include "host/compare/ssim.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::compare {
namespace {

bool isFinite(const glm::dvec3& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

/// Makes pixels black in both that are not finite in one, and counts them.
void blackenNotFinite(Picture& reference, Picture& picture, Comparison& result) {
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const bool referenceIs = isFinite(reference.rgb[i]), pictureIs = isFinite(picture.rgb[i]);
        if (referenceIs && pictureIs) {
            ++result.compared;
            continue;
        }
        if (referenceIs) ++result.notFiniteInPictureAlone;
        reference.rgb[i] = picture.rgb[i] = glm::dvec3(0);
        if (reference.film) reference.film->pixels[i] = {};
        if (picture.film) picture.film->pixels[i] = {};
    }
}

bool hasUnevenSamples(const Film& film) {
    return std::any_of(film.pixels.begin(), film.pixels.end(), [&](const PixelStatistics& p) {
        return p.count > 0 && p.count != film.pixels.front().count;
    });
}

void addFlip(const Picture& reference, const Picture& picture, double pixelsPerDegree,
             Comparison& result) {
    result.highDynamicRange = !reference.lowDynamicRange && !picture.lowDynamicRange;
    if (result.highDynamicRange) {
        HdrFlip hdr = hdrFlipMap(reference, picture, pixelsPerDegree);
        result.flipMap = std::move(hdr.map);
        result.flipStartStops = hdr.startStops;
        result.flipStopStops = hdr.stopStops;
        result.flipExposures = hdr.exposures;
    } else {
        result.flipMap = flipMap(reference, picture, pixelsPerDegree);
    }
    result.flip = meanOf(result.flipMap);
}

} // namespace

Comparison comparePictures(const Picture& referenceIn, const Picture& pictureIn,
                           const CompareSettings& settings) {
    if (referenceIn.width != pictureIn.width || referenceIn.height != pictureIn.height)
        throw UsageError(fmt::format("the reference has {} x {} pixels, the picture {} x {}",
                                     referenceIn.width, referenceIn.height, pictureIn.width,
                                     pictureIn.height));
    Comparison result;
    result.width = referenceIn.width;
    result.height = referenceIn.height;
    result.notFiniteReference = countNotFinite(referenceIn);
    result.notFinitePicture = countNotFinite(pictureIn);
    Picture reference = referenceIn, picture = pictureIn;
    blackenNotFinite(reference, picture, result);
    result.errors = linearErrors(reference, picture);
    result.psnr = psnr(reference, picture, settings.exposure);
    result.ssim = ssim(reference, picture, settings.exposure);
    addFlip(reference, picture, settings.pixelsPerDegree, result);
    if (reference.film && picture.film) {
        CheckSettings check;
        check.familyError = settings.familyError;
        result.zTest = crossCheck(*picture.film, *reference.film, check);
        result.branches = std::max(reference.film->branches, picture.film->branches);
        result.unevenSamples = hasUnevenSamples(*reference.film) || hasUnevenSamples(*picture.film);
    }
    return result;
}

std::vector<std::string> violations(const Comparison& c, const Thresholds& t) {
    if (t.zTest && !c.zTest)
        throw UsageError("--ztest needs the variances of both pictures: EXR files of render --aov");
    std::vector<std::string> lines;
    if (t.any() && c.notFiniteInPictureAlone > 0)
        lines.push_back(fmt::format("{} pixels are not finite, but are in the reference",
                                    c.notFiniteInPictureAlone));
    if (t.any() && c.compared == 0) lines.emplace_back("no pixel is finite in both pictures");
    const auto atMost = [&](const char* name, double value, const std::optional<double>& limit) {
        if (limit && !(value <= *limit))
            lines.push_back(fmt::format("{} is {:.6g}, above {:.6g}", name, value, *limit));
    };
    const auto atLeast = [&](const char* name, double value, const std::optional<double>& limit) {
        if (limit && !(value >= *limit))
            lines.push_back(fmt::format("{} is {:.6g}, below {:.6g}", name, value, *limit));
    };
    atMost("MSE", c.errors.mse, t.mse);
    atMost("relMSE", c.errors.relMse, t.relMse);
    atMost("FLIP", c.flip, t.flip);
    for (size_t i = 0; i < 3; ++i)
        atMost(i == 0   ? "red bias (%)"
               : i == 1 ? "green bias (%)"
                        : "blue bias (%)",
               100 * std::abs(c.errors.relativeBias[i]), t.biasPercent);
    atLeast("PSNR", c.psnr, t.psnr);
    atLeast("SSIM", c.ssim, t.ssim);
    if (t.zTest && c.zTest->verdict() == Verdict::Different)
        lines.emplace_back("the z-tests find a difference");
    if (t.zTest && c.zTest->verdict() == Verdict::Undecided)
        lines.emplace_back("the z-tests could not have found a difference: too few samples");
    if (c.acceptance && !c.acceptance->accepted())
        lines.push_back(fmt::format("{:.4f} % of the z-tests by the reference's variance pass, "
                                    "fewer than {:.2f} %",
                                    100 * c.acceptance->share(), 100 * c.acceptance->required));
    if (t.blocks && !c.blockAcceptance)
        throw UsageError("--ztest-blocks needs the variance of the reference: --ztest-variance");
    if (t.blocks && !c.blockAcceptance->accepted())
        lines.push_back(
            fmt::format("the means of the picture or of blocks differ: |z| up to {:.2f}",
                        c.blockAcceptance->worst()));
    return lines;
}

} // namespace stromboli::compare
