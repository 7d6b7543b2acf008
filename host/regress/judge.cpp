#include "host/regress/judge.hpp"

#include "host/check/cross_check.hpp"
#include "host/compare/flip.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/film/tone_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::regress {

const char* nameOf(Verdict verdict) {
    switch (verdict) {
    case Verdict::Agrees:
        return "agrees";
    case Verdict::Differs:
        return "differs";
    case Verdict::Undecided:
        return "undecided";
    case Verdict::NoGolden:
        return "no golden";
    case Verdict::Failed:
        return "failed";
    case Verdict::Updated:
        return "updated";
    case Verdict::NotRun:
        return "not run";
    }
    return "";
}

bool Results::passed() const {
    return std::ranges::all_of(outcomes, [](const Outcome& o) {
        return o.verdict == Verdict::Agrees || o.verdict == Verdict::Updated;
    });
}

bool Results::failed() const {
    return std::ranges::any_of(outcomes, [](const Outcome& o) {
        return o.verdict == Verdict::Differs || o.verdict == Verdict::NoGolden ||
               o.verdict == Verdict::Failed;
    });
}

double falseAlarmsOfEach(const Suite& suite) {
    return sidakLevel(suite.falseAlarms, suite.pictures.size());
}

namespace {

/// What of a z-test fails.
void addReasons(const CheckResult& z, std::vector<std::string>& reasons) {
    if (!z.channelsAgree) {
        const auto worst = std::ranges::max_element(
            z.channels, {}, [](const CheckChannel& c) { return std::abs(c.z); });
        reasons.push_back(fmt::format("the mean is off by {:+.2f} % (z {:+.1f}, limit {:.1f})",
                                      100 * worst->relativeDifference, worst->z, z.channelLimit));
    }
    if (!z.blocksAgree)
        reasons.push_back(fmt::format("the block of {} x {} pixels at ({}, {}) differs (z {:+.1f}, "
                                      "limit {:.1f})",
                                      z.worstBlock.width, z.worstBlock.height, z.worstBlock.x,
                                      z.worstBlock.y, z.worstBlock.z, z.blockLimit));
    if (!z.pixelsAgree)
        reasons.push_back(
            fmt::format("{:.2f} % of the pixels differ", 100 * (1 - z.fractionPassing)));
    if (!z.constantsAgree)
        reasons.push_back(fmt::format("{} pixels without noise differ", z.constantMismatches));
}

} // namespace

void judge(const compare::Picture& golden, const compare::Picture& picture, double falseAlarms,
           Outcome& outcome) {
    compare::CompareSettings settings;
    settings.familyError = falseAlarms;
    outcome.comparison = compare::comparePictures(golden, picture, settings);
    const compare::Comparison& c = *outcome.comparison;
    outcome.reasons = compare::violations(c, outcome.which.limits);
    if (c.zTest && c.zTest->anyDiffers()) addReasons(*c.zTest, outcome.reasons);
    const bool canTell = c.zTest || outcome.which.limits.any();
    if (!canTell && c.errors.mse > 0)
        outcome.reasons.push_back("values differ, and the golden picture has neither variances "
                                  "(--update) nor limits");
    outcome.verdict = Verdict::Agrees;
    if (c.zTest && c.zTest->verdict() == stromboli::Verdict::Undecided) {
        outcome.verdict = Verdict::Undecided;
        outcome.reasons.push_back("too few samples to tell anything");
    }
    if (!outcome.reasons.empty() && outcome.verdict == Verdict::Agrees)
        outcome.verdict = Verdict::Differs;
}

void noteBudgets(Outcome& outcome) {
    const SuitePicture& p = outcome.which;
    if (p.seconds && outcome.seconds > *p.seconds)
        outcome.remarks.push_back(
            fmt::format("took {:.1f} s, of a budget of {:g} s", outcome.seconds, *p.seconds));
    if (p.megabytes && outcome.megabytes > *p.megabytes)
        outcome.remarks.push_back(
            fmt::format("took {:.0f} MB, of a budget of {:g} MB", outcome.megabytes, *p.megabytes));
}

namespace {

ByteImage shown(const compare::Picture& picture) {
    Film film(picture.width, picture.height);
    for (size_t i = 0; i < picture.rgb.size(); ++i) {
        film.pixels[i].count = 1;
        film.pixels[i].mean = picture.rgb[i];
    }
    return toneMap(film, {});
}

} // namespace

void writePictures(const std::filesystem::path& folder, const compare::Picture& golden,
                   const compare::Picture& picture, Outcome& outcome) {
    const auto write = [&](const char* what, const ByteImage& image) {
        std::string name = outcome.which.name + "-" + what + ".png";
        writePng((folder / name).string(), image, PngColorSpace::Srgb);
        return name;
    };
    outcome.goldenPicture = write("golden", shown(golden));
    outcome.newPicture = write("new", shown(picture));
    if (!outcome.comparison) return;
    const compare::Comparison& c = *outcome.comparison;
    outcome.flipPicture = write("flip", compare::falseColor(c.flipMap, c.width, c.height, 1));
    outcome.differencePicture = write("difference", compare::signedDifference(golden, picture));
}

} // namespace stromboli::regress
