#include "host/compare/comparison.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stromboli::compare {

// --- Acceptance tests ----------------------------------------------------------------------------

namespace {

constexpr double kFamilyError = 0.01;
constexpr double kRequired = 0.9975;
} // namespace

void requireSameSize(const Picture& reference, const Picture& other, const char* what) {
    if (other.width != reference.width || other.height != reference.height)
        throw UsageError(fmt::format("the reference has {} x {} pixels, {} {} x {}",
                                     reference.width, reference.height, what, other.width,
                                     other.height));
}

Acceptance judgeByVariance(const Picture& reference, const Picture& variance,
                           const Picture& picture, uint64_t samples) {
    requireSameSize(reference, variance, "its variance");
    requireSameSize(reference, picture, "the picture");
    Acceptance result;
    result.samples = samples;
    result.limit = twoSidedQuantile(sidakLevel(kFamilyError, reference.rgb.size()));
    result.tests = 3 * reference.rgb.size();
    result.required = kRequired;
    const double perSample =
        1 / double(samples) + (samples > kIgnoredBelow ? 1 / kReferenceSamples : 0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const glm::dvec3 difference = kXyzFromLinear * (picture.rgb[i] - reference.rgb[i]);
        const glm::dvec3 ofSample = kXyzFromLinear * variance.rgb[i];
        for (int c = 0; c < 3; ++c) {
            const double deviation =
                std::sqrt(std::fmax(ofSample[c], kLeastSampleVariance) * perSample);
            double z = std::abs(difference[c]) / deviation;
            if (!std::isfinite(z)) z = std::numeric_limits<double>::infinity();
            if (z < result.limit) ++result.passing;
            if (z <= result.largest) continue;
            result.largest = z;
            result.x = uint32_t(i % reference.width);
            result.y = uint32_t(i / reference.width);
        }
    }
    return result;
}

namespace {

/// The sum of the differences of some pixels and of their variances, in CIE XYZ.
struct Sum {
    glm::dvec3 difference{0.0}, variance{0.0};

    void operator+=(const Sum& other) {
        difference += other.difference;
        variance += other.variance;
    }
    glm::dvec3 z() const {
        glm::dvec3 z = difference / glm::sqrt(variance);
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(z[c])) z[c] = std::numeric_limits<double>::infinity();
        return z;
    }
};

/// The largest variance that X, Y and Z can have if red, green and blue have these.
glm::dvec3 largestInXyz(const glm::dvec3& variance) {
    const glm::dvec3 deviation = kXyzFromLinear * glm::sqrt(variance);
    return deviation * deviation;
}

Sum sumOfPixel(const Picture& reference, const Picture& variance, const Picture& picture, size_t i,
               uint64_t samples, double referenceSamples) {
    const glm::dvec3 ofSample =
        glm::max(kXyzFromLinear * variance.rgb[i], glm::dvec3(kLeastSampleVariance));
    const glm::dvec3 own = picture.film ? largestInXyz(picture.film->pixels[i].varianceOfMean())
                                        : ofSample / double(samples);
    return {kXyzFromLinear * (picture.rgb[i] - reference.rgb[i]),
            own + ofSample / referenceSamples};
}

double largestOf(const glm::dvec3& z) {
    return std::max({std::abs(z.x), std::abs(z.y), std::abs(z.z)});
}

} // namespace

double BlockAcceptance::worst() const {
    return std::max(largest, largestOf(means));
}

BlockAcceptance judgeBlocks(const Picture& reference, const Picture& variance,
                            const Picture& picture, uint64_t samples, double referenceSamples,
                            double familyError) {
    requireSameSize(reference, variance, "its variance");
    requireSameSize(reference, picture, "the picture");
    constexpr uint32_t kSide = BlockAcceptance::kSide;
    const uint32_t across = (reference.width + kSide - 1) / kSide,
                   down = (reference.height + kSide - 1) / kSide;
    std::vector<Sum> blocks(size_t(across) * down);
    Sum all;
    glm::dvec3 difference(0.0), expected(0.0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const Sum pixel = sumOfPixel(reference, variance, picture, i, samples, referenceSamples);
        const size_t x = i % reference.width / kSide, y = i / reference.width / kSide;
        blocks[y * across + x] += pixel;
        all += pixel;
        difference += picture.rgb[i] - reference.rgb[i];
        expected += reference.rgb[i];
    }
    BlockAcceptance result;
    result.familyError = familyError;
    result.tests = 3 * (blocks.size() + 1);
    result.limit = twoSidedQuantile(sidakLevel(familyError, result.tests));
    result.means = all.z();
    result.errors = difference / expected;
    result.noise = glm::sqrt(all.variance) / (kXyzFromLinear * expected);
    result.hasOwnNoise = picture.film.has_value();
    for (size_t i = 0; i < blocks.size(); ++i) {
        const double z = largestOf(blocks[i].z());
        if (z <= result.largest) continue;
        result.largest = z;
        result.x = uint32_t(i % across) * kSide;
        result.y = uint32_t(i / across) * kSide;
    }
    return result;
}

// --- Comparisons ---------------------------------------------------------------------------------

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

namespace {

constexpr const char* kColors[] = {"red", "green", "blue"};

std::string flipName(const Comparison& c) {
    if (!c.highDynamicRange) return "FLIP (LDR)";
    return "FLIP (HDR)";
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
