#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/compare/false_color.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/core/log.hpp"
#include "host/core/output.hpp"
#include "host/film/exr.hpp"
#include "host/film/png.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli {
namespace {

using compare::Comparison;
using compare::Picture;

ByteImage differenceImage(const Picture& reference, const Picture& picture, const Comparison& c,
                          DifferenceView show) {
    if (show == DifferenceView::Signed) return compare::signedDifference(reference, picture);
    if (show == DifferenceView::Flip) return compare::falseColor(c.flipMap, c.width, c.height, 1);
    std::vector<double> errors = compare::relativeErrorMap(reference, picture);
    for (double& error : errors)
        error = std::sqrt(error);
    return compare::falseColor(errors, c.width, c.height, 1);
}

FloatImage differenceValues(const Picture& reference, const Picture& picture) {
    FloatImage image(picture.width, picture.height);
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        std::vector<float>& channel = image.channel(names[c]);
        for (size_t i = 0; i < channel.size(); ++i)
            channel[i] = float(picture.rgb[i][c] - reference.rgb[i][c]);
    }
    return image;
}

void writeDifference(const CompareOptions& o, const Picture& reference, const Picture& picture,
                     const Comparison& comparison) {
    if (o.differenceFile.empty()) return;
    if (o.differenceFile.ends_with(".exr") || o.differenceFile.ends_with(".EXR"))
        writeExr(o.differenceFile, differenceValues(reference, picture));
    else
        writePng(o.differenceFile, differenceImage(reference, picture, comparison, o.show),
                 PngColorSpace::Srgb);
}

void writeFigures(const CompareOptions& o, const Comparison& comparison,
                  const std::vector<std::string>& broken) {
    if (!isStandardOutput(o.jsonFile)) fmt::print("{}", compare::toText(comparison));
    if (o.jsonFile.empty()) return;
    Json json = compare::toJson(comparison);
    json["reference"] = o.reference;
    json["picture"] = o.picture;
    json["violations"] = broken;
    writeOutput(o.jsonFile, json.dump(2) + "\n");
}

/// Those of each pixel of the picture that is judged.
uint64_t samplesOf(const CompareOptions& o, const Picture& picture) {
    if (o.samples) return *o.samples;
    const auto fail = [&] {
        throw UsageError(o.picture + " does not say how many samples each of its pixels has: "
                                     "--ztest-variance needs -s N");
    };
    if (!picture.film) fail();
    const uint64_t count = picture.film->pixels.front().count;
    for (const PixelStatistics& pixel : picture.film->pixels)
        if (pixel.count != count || count == 0) fail();
    return count * picture.film->branches;
}

/// By the variance of one sample of the reference.
void judgeByVariance(const CompareOptions& o, const Picture& reference, const Picture& picture,
                     Comparison& comparison) {
    const Picture variance = compare::readPicture(o.varianceFile);
    const uint64_t samples = samplesOf(o, picture);
    comparison.acceptance = compare::judgeByVariance(reference, variance, picture, samples);
    comparison.blockAcceptance = compare::judgeBlocks(reference, variance, picture, samples,
                                                      o.referenceSamples, o.settings.familyError);
}

} // namespace

int compareCommand(const Options& options) {
    const CompareOptions& o = options.compare;
    nowDoing("comparing " + o.picture);
    const Picture reference = compare::readPicture(o.reference);
    const Picture picture = compare::readPicture(o.picture);
    Comparison comparison = compare::comparePictures(reference, picture, o.settings);
    if (!o.varianceFile.empty()) judgeByVariance(o, reference, picture, comparison);
    if (o.familyErrorGiven && !comparison.zTest && !comparison.blockAcceptance)
        logging::warn(fmt::format("{} has no variances (render --aov writes them into EXR files), "
                                  "so there are no z-tests: ignored: --alpha",
                                  reference.film ? o.picture : o.reference));
    const std::vector<std::string> broken = compare::violations(comparison, o.thresholds);
    writeDifference(o, reference, picture, comparison);
    nowDoing("printing", StatusLine::OfOthers);
    writeFigures(o, comparison, broken);
    for (const std::string& line : broken)
        fmt::print(stderr, "{}: {}\n", o.picture, line);
    return broken.empty() ? 0 : int(ExitCode::Device);
}

} // namespace stromboli
