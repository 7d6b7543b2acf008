#include "host/cli/study_options.hpp"

#include "host/core/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

/// The configuration that others are compared with, where it takes part.
constexpr const char* kUsualBaseline = "independent";

const std::vector<std::string> kUsualConfigurations = {"independent", "even", "default",
                                                       "hemisphere"};

void addScenes(CLI::App& app, RawStudyOptions& raw, StudyOptions& o) {
    app.add_option("SCENE", raw.scenes,
                   "files, scenes of scene/library by name, or generate:cornell_mesh:N")
        ->group("Scenes");
    app.add_option("-o,--output", o.folder,
                   "folder for report.html, study.json, study.csv, references and pictures; a "
                   "study that was stopped goes on where the same command finds its folder")
        ->default_str("study")
        ->type_name("FOLDER")
        ->group("Output");
}

void addConfigurations(CLI::App& app, RawStudyOptions& raw, StudyOptions& o) {
    app.add_option("-c,--config", raw.configurations,
                   "a configuration by name (--list), or one of your own as NAME=OPTIONS of "
                   "render; an option with {a,b,c} grows along these values instead of along "
                   "samples, as \"mine=-a 16 {0.4,0.2,0.1}\"; once for each "
                   "[independent, even, default, hemisphere]")
        ->allow_extra_args(false)
        ->type_name("NAME")
        ->group("Configurations");
    app.add_flag("--list", o.list, "print the known configurations")->group("Configurations");
    app.add_option("--baseline", o.settings.baseline,
                   "what the others are compared with [independent if it takes part, else the "
                   "first]")
        ->type_name("NAME")
        ->group("Configurations");
    app.add_option("--options", raw.moreOptions, "options of render for every picture")
        ->type_name("OPTIONS")
        ->group("Configurations");
}

void addMeasuring(CLI::App& app, RawStudyOptions& raw, StudyOptions& o) {
    app.add_option("-r,--size", raw.size, "picture size [480 360; --quick: 160 120]")
        ->expected(2)
        ->allow_extra_args(false)
        ->type_name("W H")
        ->group("Measuring");
    app.add_option("-m,--max-bounces", raw.maxBounces, "scatterings of light at most [5]")
        ->type_name("N")
        ->group("Measuring");
    app.add_option("-s,--samples", raw.sampleCounts,
                   "growing sample counts [4,16,64,256; --quick: 4,16,64]")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("N,N,...")
        ->group("Measuring");
    app.add_option("--seeds", raw.seeds, "runs of each configuration [4; --quick: 3]")
        ->type_name("N")
        ->group("Measuring");
    app.add_option("--reference-samples", raw.referenceSamples,
                   "of the picture that errors are measured against [16 times the largest count]")
        ->type_name("N")
        ->group("Measuring");
    app.add_option("--target-samples", raw.targetSamples,
                   "times are compared at the error of the baseline with so many samples [64, or "
                   "the largest count]")
        ->type_name("N")
        ->group("Measuring");
    app.add_option("--most-seconds", o.settings.mostSecondsPerRun,
                   "efforts that would take longer are left out")
        ->check(CLI::PositiveNumber)
        ->default_str("120")
        ->type_name("S")
        ->group("Measuring");
    app.add_flag("--quick", raw.quick, "a short study: small pictures, fewer samples and seeds")
        ->group("Measuring");
}

void checkRange(const char* what, uint32_t value, uint32_t least, uint32_t most) {
    if (value < least || value > most)
        throw UsageError(fmt::format("{} is {}: expected {} to {}", what, value, least, most));
}

void applyCounts(const RawStudyOptions& raw, study::StudySettings& s) {
    if (raw.quick) s.sampleCounts = {4, 16, 64};
    if (!raw.sampleCounts.empty()) s.sampleCounts = raw.sampleCounts;
    constexpr uint32_t kMost = 1u << 20; // a reference of 16 times that is the most there can be
    for (size_t i = 0; i < s.sampleCounts.size(); ++i) {
        checkRange("-s", s.sampleCounts[i], 1, kMost);
        if (i > 0 && s.sampleCounts[i] <= s.sampleCounts[i - 1])
            throw UsageError("-s: the sample counts must grow");
    }
    if (s.sampleCounts.size() < 2) throw UsageError("-s: at least two sample counts are needed");
    s.seeds = raw.seeds.value_or(raw.quick ? 3 : 4);
    checkRange("--seeds", s.seeds, 1, 10000);
    s.referenceSamples = raw.referenceSamples.value_or(16 * s.sampleCounts.back());
    checkRange("--reference-samples", s.referenceSamples, s.sampleCounts.back(), 16 * kMost);
    s.targetSamples = raw.targetSamples.value_or(std::min(64u, s.sampleCounts.back()));
    checkRange("--target-samples", s.targetSamples, s.sampleCounts.front(), s.sampleCounts.back());
}

void applyBaseline(study::StudySettings& s) {
    const auto has = [&](const std::string& name) {
        return std::any_of(s.configurations.begin(), s.configurations.end(),
                           [&](const study::Configuration& c) { return c.name == name; });
    };
    if (s.baseline.empty())
        s.baseline = has(kUsualBaseline) ? kUsualBaseline : s.configurations.front().name;
    if (!has(s.baseline))
        throw UsageError(fmt::format("--baseline: '{}' takes no part in the study", s.baseline));
    for (const study::Configuration& c : s.configurations)
        if (c.name == s.baseline && !c.effort.empty())
            throw UsageError(fmt::format(
                "--baseline: '{}' does not grow along samples; choose another", s.baseline));
}

} // namespace

void declareStudy(CLI::App& app, RawStudyOptions& raw, StudyOptions& o) {
    addScenes(app, raw, o);
    addConfigurations(app, raw, o);
    addMeasuring(app, raw, o);
    app.footer("Errors are relMSE, the mean of (x - r)^2 / (r^2 + 0.01 m^2), r the reference and m "
               "its mean, less what the reference's own noise adds. Times are those of sampling "
               "alone.\nExample: stromboli study cornell_boxes island -c default -c hemisphere "
               "-c \"four=-l 4\" --seeds 8");
}

void applyStudy(const RawStudyOptions& raw, StudyOptions& o) {
    study::StudySettings& s = o.settings;
    s.configurations = study::chooseConfigurations(raw.configurations.empty() ? kUsualConfigurations
                                                                              : raw.configurations);
    s.scenes = raw.scenes;
    if (s.scenes.empty() && !o.list) throw UsageError("SCENE is required (see --help)");
    const std::vector<uint32_t> usual =
        raw.quick ? std::vector<uint32_t>{160, 120} : std::vector<uint32_t>{480, 360};
    const std::vector<uint32_t>& size = raw.size.empty() ? usual : raw.size;
    s.commonOptions =
        fmt::format("-r {} {} -m {}{}{}", size[0], size[1], raw.maxBounces.value_or(5),
                    raw.moreOptions.empty() ? "" : " ", raw.moreOptions);
    s.referenceOptions = "--sampler independent"; // no structure that a study's runs might share
    applyCounts(raw, s);
    applyBaseline(s);
}

} // namespace stromboli
