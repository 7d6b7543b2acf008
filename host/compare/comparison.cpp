#include "host/compare/comparison.hpp"

#include "host/compare/metrics.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
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

namespace {

constexpr const char* kColors[] = {"red", "green", "blue"};

std::string flipName(const Comparison& c) {
    if (!c.highDynamicRange) return "FLIP (LDR)";
    return "FLIP (HDR)";
}

Json toJson(const CheckResult& z) {
    Json channels = Json::array(), visible = Json::array();
    for (const CheckChannel& channel : z.channels) {
        channels.push_back(channel.z);
        visible.push_back(channel.visible); // null: no difference is
    }
    const char* const verdicts[] = {"agree", "different", "undecided"};
    return {{"agree", z.agree()},
            {"verdict", verdicts[size_t(z.verdict())]},
            {"channels", channels},
            {"visible", visible},
            {"power", z.power},
            {"channelLimit", z.channelLimit},
            {"worstBlock", z.worstBlock.z},
            {"blockLimit", z.blockLimit},
            {"pixelsPassing", z.fractionPassing},
            {"constantMismatches", z.constantMismatches}};
}

Json toJson(const Acceptance& a) {
    return {{"accepted", a.accepted()}, {"share", a.share()},   {"required", a.required},
            {"samples", a.samples},     {"tests", a.tests},     {"passing", a.passing},
            {"limit", a.limit},         {"largest", a.largest}, // null: not finite
            {"pixel", {a.x, a.y}}};
}

std::string toText(const Acceptance& a) {
    return fmt::format("by the reference's variance, {} samples: {} of {} z-tests pass ({:.4f} %, "
                       "{:.2f} % must), |z| < {:.2f}; largest {:.2f} at {} {}: {}\n",
                       a.samples, a.passing, a.tests, 100 * a.share(), 100 * a.required, a.limit,
                       a.largest, a.x, a.y, a.accepted() ? "ACCEPTED" : "NOT ACCEPTED");
}

Json toJson(const BlockAcceptance& a) {
    const auto numbers = [](const glm::dvec3& v) { return std::array{v.x, v.y, v.z}; };
    return {{"accepted", a.accepted()},
            {"means", numbers(a.means)},
            {"relativeErrors", numbers(a.errors)},
            {"relativeNoise", numbers(a.noise)},
            {"largestBlock", a.largest},
            {"block", {a.x, a.y}},
            {"limit", a.limit},
            {"tests", a.tests},
            {"familyError", a.familyError},
            {"ownNoise", a.hasOwnNoise}};
}

std::string toText(const BlockAcceptance& a) {
    return fmt::format(
        "by means and blocks, {}: |z| of X {:.2f}, Y {:.2f}, Z {:.2f} (one standard "
        "deviation of Y is {:.3f} %); largest of a block of 8 x 8 {:.2f} at {} {}; "
        "|z| < {:.2f}: {}\n",
        a.hasOwnNoise ? "with the variances of both" : "with the reference's variance for both",
        std::abs(a.means.x), std::abs(a.means.y), std::abs(a.means.z), 100 * a.noise.y, a.largest,
        a.x, a.y, a.limit, a.accepted() ? "AGREE" : "DIFFER");
}

} // namespace

std::string toText(const Comparison& c) {
    std::string text =
        fmt::format("{:<11} {:.6g}\n{:<11} {:.6g}   of linear radiance, epsilon {:.3g}\n"
                    "{:<11} {:.2f} dB   of sRGB signals\n{:<11} {:.6f}   of sRGB signals, grey\n",
                    "MSE", c.errors.mse, "relMSE", c.errors.relMse, c.errors.epsilon, "PSNR",
                    c.psnr, "SSIM", c.ssim);
    text += fmt::format("{:<11} {:.6f}", flipName(c), c.flip);
    if (c.highDynamicRange)
        text += fmt::format("   {} exposures, {:+.2f} to {:+.2f} stops", c.flipExposures,
                            c.flipStartStops, c.flipStopStops);
    text += "\nbias       ";
    for (size_t i = 0; i < 3; ++i)
        text += fmt::format(" {} {:+.4f} %", kColors[i], 100 * c.errors.relativeBias[i]);
    text += "\n";
    if (c.notFiniteReference + c.notFinitePicture > 0)
        text += fmt::format("not finite: {} pixels of the reference, {} of the picture; left out\n",
                            c.notFiniteReference, c.notFinitePicture);
    if (c.acceptance) text += toText(*c.acceptance);
    if (c.blockAcceptance) text += toText(*c.blockAcceptance);
    if (!c.zTest) return text;
    text += "z-tests, A the picture, B the reference:\n" + formatCheck(*c.zTest);
    if (c.branches > 1)
        text += fmt::format("note: {} paths share each sample (--branches): variances rest on so "
                            "many times fewer samples than -s counts\n",
                            c.branches);
    if (c.unevenSamples)
        text += "note: sample counts vary; adaptive sampling is slightly biased, and tests with "
                "many samples may see it\n";
    return text;
}

Json toJson(const Comparison& c) {
    // JSON has no infinity: PSNR is null for equal pictures.
    return {{"width", c.width},
            {"height", c.height},
            {"mse", c.errors.mse},
            {"relMse", c.errors.relMse},
            {"relMseEpsilon", c.errors.epsilon},
            {"psnr", std::isfinite(c.psnr) ? Json(c.psnr) : Json(nullptr)},
            {"ssim", c.ssim},
            {"flip",
             {{"mean", c.flip},
              {"kind", c.highDynamicRange ? "hdr" : "ldr"},
              {"exposures", c.flipExposures},
              {"startStops", c.flipStartStops},
              {"stopStops", c.flipStopStops}}},
            {"bias", c.errors.bias},
            {"relativeBias", c.errors.relativeBias},
            {"notFinite",
             {{"reference", c.notFiniteReference},
              {"picture", c.notFinitePicture},
              {"pictureAlone", c.notFiniteInPictureAlone}}},
            {"zTest", c.zTest ? toJson(*c.zTest) : Json(nullptr)},
            {"acceptance", c.acceptance ? toJson(*c.acceptance) : Json(nullptr)},
            {"blockAcceptance", c.blockAcceptance ? toJson(*c.blockAcceptance) : Json(nullptr)},
            {"branches", c.branches},
            {"unevenSamples", c.unevenSamples}};
}

} // namespace stromboli::compare
