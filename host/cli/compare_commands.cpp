#include "host/check/cross_check.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/compare/flip.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/json.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>

namespace stromboli {

// --- compare -------------------------------------------------------------------------------------

// `compare`: how far a picture is from a reference.

namespace {

using compare::Comparison;
using compare::Picture;

constexpr Range<double> kErrors{0, 1e300}, kDecibels{-1000, 1000}, kSimilarities{-1, 1},
    kFlip{0, 1}, kPercent{0, 1e9}, kStops{-100, 100}, kPixelsPerDegree{1, 1000},
    kFalseAlarms{1e-12, 0.5};
constexpr Range<uint32_t> kSampleCounts{1, 1u << 30};

void declareThresholds(OptionList& list, compare::Thresholds& t) {
    list.group("Limits (exit code 3 if one is not kept)");
    list.real("--max-mse", "X", "mean squared error of linear radiance", t.mse, kErrors);
    list.real("--max-relmse", "X",
              "mean of (x - r)^2 / (r^2 + 0.01 m^2), r the reference, m its mean", t.relMse,
              kErrors);
    list.real("--min-psnr", "DB", "PSNR of the sRGB signals, in dB", t.psnr, kDecibels);
    list.real("--min-ssim", "X", "structural similarity of the grey sRGB signals", t.ssim,
              kSimilarities);
    list.real("--max-flip", "X", "mean FLIP: HDR-FLIP of two linear pictures, FLIP if one is a PNG",
              t.flip, kFlip);
    list.real("--max-bias", "PERCENT",
              "difference of the means of each channel, in percent of the reference's",
              t.biasPercent, kPercent, kPercents);
    list.flag("--ztest",
              "the pictures must agree within their variances (two EXR files of render --aov, "
              "different seeds)",
              t.zTest);
}

bool namesPng(const std::string& file) {
    return file.ends_with(".png") || file.ends_with(".PNG");
}

void checkFiles(const CompareOptions& o) {
    if (!o.differenceFile.empty()) {
        const PictureFormat format = formatOf(o.differenceFile);
        if (format == PictureFormat::Jpeg || format == PictureFormat::WebP)
            throw UsageError(
                fmt::format("--diff {}: expected a .png or an .exr file", o.differenceFile));
        checkWritable(o.differenceFile);
    }
    if (!o.jsonFile.empty()) checkOutputWritable(o.jsonFile);
    for (const std::string& out : {o.differenceFile, o.jsonFile})
        if (!out.empty() && (out == o.reference || out == o.picture))
            throw UsageError(out + ": the output would replace a picture that is compared");
    if (!o.jsonFile.empty() && o.jsonFile == o.differenceFile)
        throw UsageError("--json and --diff name the same file: " + o.jsonFile);
}

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

void declareCompare(DeclaredCommand& c) {
    const auto owned = std::make_shared<CompareOptions>();
    CompareOptions& o = *owned;
    OptionList& list = c.list;
    list.group("Pictures");
    list.text("REF", "", "the reference: .png (sRGB), .exr or .pfm (linear)", o.reference)
        .required()
        .proposes(Proposed::Files);
    list.text("IMG", "", "the picture to judge, of the same size", o.picture)
        .required()
        .proposes(Proposed::Files);
    declareThresholds(list, o.thresholds);
    list.text("--ztest-variance", "FILE",
              "IMG must agree with REF by the variance of one sample of REF, as Mitsuba 3 judges "
              "its render tests: in CIE XYZ, 99.75 % of all |IMG - REF| sqrt(N / max(variance, "
              "1e-4)) "
              "are below a limit that no pixel exceeds in 99 of 100 pictures",
              o.varianceFile)
        .proposes(Proposed::Files);
    list.number("-s,--samples", "N", "samples of each pixel of IMG, for --ztest-variance",
                o.samples, kSampleCounts)
        .usually("those that IMG states (render --aov)")
        .needs("--ztest-variance");
    list.flag(
            "--ztest-blocks",
            "beside --ztest-variance: the means of the picture and of blocks of 8 x 8 pixels must "
            "agree as well, within the variances of both (render --aov; else REF's for both)",
            o.thresholds.blocks)
        .needs("--ztest-variance");
    list.real("--reference-samples", "N", "samples of each pixel of REF, for the means and blocks",
              o.referenceSamples, {1, 1e18})
        .needs("--ztest-variance");
    list.group("Output");
    list.text("--diff", "FILE", "write the difference: .png in false colour, .exr as IMG - REF",
              o.differenceFile)
        .proposes(Proposed::Files);
    list.choice("--show", "WHAT", "what --diff FILE.png shows", o.show);
    list.text("--json", "FILE.json", "write all figures as JSON; - for standard output", o.jsonFile)
        .proposes(Proposed::Files);
    list.group("Metrics");
    list.real("--exposure", "EV", "radiance times 2^EV before PSNR and SSIM look at it",
              o.settings.exposure, kStops);
    list.real("--ppd", "N",
              "FLIP: pixels per degree of the viewer's sight (67: 0.7 m from a 4K screen 0.7 m "
              "wide)",
              o.settings.pixelsPerDegree, kPixelsPerDegree)
        .usually(fmt::format("{:.2f}", o.settings.pixelsPerDegree));
    list.real("--alpha", "P", "z-tests: probability of a false alarm", o.settings.familyError,
              kFalseAlarms);
    c.finish = [&c, owned] {
        checkFiles(*owned);
        owned->familyErrorGiven = c.has("--alpha");
        if (c.has("--show") && !namesPng(owned->differenceFile))
            throw UsageError("--show says what --diff FILE.png shows: there is no such file");
        return *owned;
    };
}

int compareCommand(const CompareOptions& o) {
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

// --- check ---------------------------------------------------------------------------------------

// `check`: the device against the reference.

namespace {

constexpr Range<double> kErrorRates{1e-12, 0.5};

/// The samples of a picture; its progress is shown.
Film renderWatched(RenderSession& session, const SceneAndPicture& work, const LoadedScene& scene) {
    ProgressBar bar;
    SessionEvents events;
    events.progress = [&bar](const RenderProgress& progress) {
        bar.show(progress);
        return Next::GoOn;
    };
    session.begin(scene.scene, work.picture);
    if (session.run(events).bands > 1)
        throw UsageError("the films of the picture do not fit the memory: give another -r");
    return session.film();
}

} // namespace

void declareCheck(DeclaredCommand& c) {
    const auto o = std::make_shared<CheckOptions>();
    const auto asked = std::make_shared<Asked>();
    o->picture.size = {160, 120}; // quick
    asked->usualPaths = 256;
    declareScene(c.list, o->scene, &o->scenes);
    declarePicture(c.list, o->picture, *asked);
    declareEstimator(c.list, *o, *asked);
    declareSamples(c.list, o->picture, *asked, "samples per pixel");
    declareBranches(c.list, o->picture, "1");
    c.list.group("Sampling");
    c.list.real("--alpha", "P", "probability of a false alarm", o->familyWiseError, kErrorRates);
    c.list.group("Output");
    c.list
        .text("--json", "FILE.json", "write the verdicts as JSON; - for standard output",
              o->jsonFile)
        .proposes(Proposed::Files);
    declareDevice(c.list, o->device.device);
    declareHost(c);
    c.finish = [&c, o, asked] {
        if (!o->jsonFile.empty()) checkOutputWritable(o->jsonFile);
        finishPicture(c, o->picture, *asked);
        finishEstimator(c, *o, *asked);
        finishBudget(o->picture, *asked);
        o->picture.budget.adaptive.enabled = false; // a z-test needs fixed sample counts
        o->device.threads = c.host.threads;
        o->device.maybeSeveral = false;
        return *o;
    };
}

namespace {

ExitCode exitCodeOf(Verdict verdict) {
    return verdict == Verdict::Agree       ? ExitCode::Success
           : verdict == Verdict::Different ? ExitCode::Device
                                           : ExitCode::TooFewSamples;
}

/// An error is worse than a difference, and that than too few samples to tell.
ExitCode worseOf(ExitCode a, ExitCode b) {
    const auto badness = [](ExitCode code) {
        switch (code) {
        case ExitCode::Success:
            return 0;
        case ExitCode::TooFewSamples:
            return 1;
        case ExitCode::Device:
            return 2;
        default:
            return 3;
        }
    };
    return badness(b) > badness(a) ? b : a;
}

/// Renders the scene in both ways and compares the two.
CheckResult checkScene(RenderSession& onDevice, RenderSession& onHost,
                       const CheckOptions& options) {
    const LoadedScene scene = loadScene(options.scene, toTerminal());
    warnOfBlackPicture(*scene.scene, options.scene.source, options.picture, toTerminal());
    const Film device = renderWatched(onDevice, options, scene);
    nowDoing("taking samples with the reference", StatusLine::OfOthers);
    const Film reference = renderWatched(onHost, options, scene);
    CheckSettings settings;
    settings.familyError = options.familyWiseError;
    return crossCheck(device, reference, settings);
}

} // namespace

/// Of several scenes one that cannot be rendered costs itself. The exit code is that of the worst:
/// an error, a difference, too few samples.
int checkCommand(const CheckOptions& options) {
    RenderSession onDevice(options.device, toTerminal()); // is opened while the scene is read
    DeviceRequest host = options.device;
    host.backend = BackendChoice::Reference;
    RenderSession onHost(host); // says nothing that the other has not said
    const bool several = options.scenes.size() > 1, prints = !isStandardOutput(options.jsonFile);
    Json scenes = Json::array();
    ExitCode worst = ExitCode::Success;
    for (const std::string& name : options.scenes)
        try {
            CheckOptions one = options;
            one.scene.source = name;
            const CheckResult result = checkScene(onDevice, onHost, one);
            Json& told = scenes.emplace_back(compare::toJson(result));
            told["scene"] = name;
            if (prints && several) fmt::print("{}\n", name);
            if (prints)
                fmt::print("A: {}\nB: {}\n{}", onDevice.result().backend, onHost.result().backend,
                           formatCheck(result));
            worst = worseOf(worst, exitCodeOf(result.verdict()));
        } catch (const Error& error) {
            if (!several || error.kind() == ErrorKind::DeviceLost) throw;
            logging::error(error.what());
            scenes.push_back({{"scene", name}, {"verdict", "failed"}, {"error", error.what()}});
            worst = worseOf(worst, exitCodeOf(error.kind()));
        }
    if (!options.jsonFile.empty())
        writeOutput(options.jsonFile,
                    Json{{"device", onDevice.result().backend}, {"scenes", scenes}}.dump(2) + "\n");
    return int(worst);
}

} // namespace stromboli
