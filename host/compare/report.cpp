#include "host/compare/comparison.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace stromboli::compare {
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
