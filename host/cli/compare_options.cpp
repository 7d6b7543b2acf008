#include "host/cli/compare_options.hpp"

#include "host/core/error.hpp"
#include "host/film/image_file.hpp"

#include <CLI/CLI.hpp>

namespace stromboli {
namespace {

void addThresholds(CLI::App& app, compare::Thresholds& t) {
    const char* const group = "Limits (exit code 3 if one is not kept)";
    app.add_option("--max-mse", t.mse, "mean squared error of linear radiance")
        ->type_name("X")
        ->group(group);
    app.add_option("--max-relmse", t.relMse,
                   "mean of (x - r)^2 / (r^2 + 0.01 m^2), r the reference, m its mean")
        ->type_name("X")
        ->group(group);
    app.add_option("--min-psnr", t.psnr, "PSNR of the sRGB signals, in dB")
        ->type_name("DB")
        ->group(group);
    app.add_option("--min-ssim", t.ssim, "structural similarity of the grey sRGB signals")
        ->type_name("X")
        ->group(group);
    app.add_option("--max-flip", t.flip,
                   "mean FLIP: HDR-FLIP of two linear pictures, FLIP if one is a PNG")
        ->type_name("X")
        ->group(group);
    app.add_option("--max-bias", t.biasPercent,
                   "difference of the means of each channel, in percent of the reference's")
        ->type_name("PERCENT")
        ->group(group);
    app.add_flag("--ztest", t.zTest,
                 "the pictures must agree within their variances (two EXR files of render --aov, "
                 "different seeds)")
        ->group(group);
}

} // namespace

void declareCompare(CLI::App& app, CompareOptions& o) {
    app.add_option("REF", o.reference, "the reference: .png (sRGB), .exr or .pfm (linear)")
        ->required()
        ->group("Pictures");
    app.add_option("IMG", o.picture, "the picture to judge, of the same size")
        ->required()
        ->group("Pictures");
    addThresholds(app, o.thresholds);
    app.add_option("--diff", o.differenceFile,
                   "write the difference: .png in false colour, .exr as IMG - REF")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--show", o.show,
                   "what --diff FILE.png shows: flip (black 0 to white 1); relative, the error "
                   "that relMSE squares (black 0 to white 1); signed (blue IMG darker, red "
                   "brighter)")
        ->check(CLI::IsMember({"flip", "relative", "signed"}))
        ->default_str("flip")
        ->type_name("WHAT")
        ->group("Output");
    app.add_option("--json", o.jsonFile, "write all figures as JSON; - for standard output")
        ->type_name("FILE.json")
        ->group("Output");
    app.add_option("--exposure", o.settings.exposure,
                   "radiance times 2^EV before PSNR and SSIM look at it")
        ->check(CLI::Range(-100.0, 100.0))
        ->default_str("0")
        ->type_name("EV")
        ->group("Metrics");
    app.add_option("--ppd", o.settings.pixelsPerDegree,
                   "FLIP: pixels per degree of the viewer's sight (67: 0.7 m from a 4K screen "
                   "0.7 m wide)")
        ->check(CLI::Range(1.0, 1000.0))
        ->default_str("67.02")
        ->type_name("N")
        ->group("Metrics");
    app.add_option("--alpha", o.settings.familyError, "z-tests: probability of a false alarm")
        ->check(CLI::Range(1e-12, 0.5))
        ->default_str("0.01")
        ->type_name("P")
        ->group("Metrics");
}

void checkCompare(const CompareOptions& o) {
    if (!o.differenceFile.empty()) checkWritable(o.differenceFile);
    for (const std::string& out : {o.differenceFile, o.jsonFile})
        if (!out.empty() && (out == o.reference || out == o.picture))
            throw UsageError(out + ": the output would replace a picture that is compared");
    if (!o.jsonFile.empty() && o.jsonFile == o.differenceFile)
        throw UsageError("--json and --diff name the same file: " + o.jsonFile);
}

} // namespace stromboli
