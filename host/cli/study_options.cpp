// Options of `study`.
#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace stromboli {
namespace {

/// The configuration that others are compared with, where it takes part.
constexpr const char* kUsualBaseline = "independent";

constexpr uint32_t kMostPaths = 1u << 20; // a reference of 16 times that is the most there can be
constexpr Range<uint32_t> kStudySamples{1, kMostPaths}, kStudySeeds{1, 10000}, kStudySide{1, 65536},
    kStudyBounces{0, 10000};
constexpr Range<double> kSeconds{1e-3, 1e9};

/// What was asked for, before it is known what it means together with the rest.
struct AskedStudy {
    Words configurations = {"independent", "even", "default", "hemisphere"};
    uint32_t width = 480, height = 360, maxBounces = 5;
    std::string moreOptions;
    std::optional<uint32_t> referenceSamples, targetSamples;
};

void declareScenes(OptionList& list, StudyOptions& o) {
    list.group("Scenes");
    list.list("SCENE", "", "files, bundled scenes by name, or generate:cornell_mesh:N",
              o.settings.scenes)
        .proposes(Proposed::Scenes);
    list.group("Output");
    list.text("-o,--output", "FOLDER",
              "folder for report.html, study.json, study.csv, references and pictures; a study "
              "that was stopped goes on where the same command finds its folder",
              o.folder)
        .proposes(Proposed::Folders);
}

void declareConfigurations(OptionList& list, AskedStudy& asked, StudyOptions& o) {
    list.group("Configurations");
    CommandOption& config = list.list(
        "-c,--config", "NAME",
        "a configuration by name (--list), or one of your own as NAME=OPTIONS of render; an option "
        "with {a,b,c} grows along these values instead of along samples, as \"mine=-a 16 "
        "{0.4,0.2,0.1}\"; once for each",
        asked.configurations);
    config.usually(fmt::format("{}", fmt::join(asked.configurations, ", ")));
    config.mayRepeat = true;
    Words known;
    for (const study::Configuration& one : study::knownConfigurations())
        known.push_back(one.name);
    config.proposes(known);
    list.flag("--list", "print the known configurations", o.list);
    list.text("--baseline", "NAME", "what the others are compared with", o.settings.baseline)
        .usually("independent if it takes part, else the first")
        .proposes(known);
    list.text("--options", "OPTIONS", "options of render for every picture", asked.moreOptions);
}

void declareMeasuring(OptionList& list, AskedStudy& asked, StudyOptions& o) {
    study::StudySettings& s = o.settings;
    list.group("Measuring");
    list.flag("--quick", "a short study: small pictures, fewer samples and seeds",
              [&asked, &s] {
                  asked.width = 160, asked.height = 120;
                  s.sampleCounts = {4, 16, 64};
                  s.seeds = 3;
              })
        .changesDefaults();
    list.numbers("-r,--size", "W H", "picture size", {&asked.width, &asked.height}, kStudySide)
        .usually(fmt::format("{} {}; --quick: 160 120", asked.width, asked.height));
    list.number("-m,--max-bounces", "N", "scatterings of light at most", asked.maxBounces,
                kStudyBounces);
    list.words("-s,--samples", "N,N,...", "growing sample counts", 1,
               [&s](const Words& words) {
                   s.sampleCounts.clear();
                   for (const std::string& word : words)
                       s.sampleCounts.push_back(readNumber("-s", word, kStudySamples));
               })
        .from(inWords(kStudySamples))
        .usually(fmt::format("{}; --quick: 4,16,64", fmt::join(s.sampleCounts, ",")))
        .separatedByCommas = true;
    list.number("--seeds", "N", "runs of each configuration", s.seeds, kStudySeeds)
        .usually(fmt::format("{}; --quick: 3", s.seeds));
    list.number("--reference-samples", "N", "of the picture that errors are measured against",
                asked.referenceSamples, {1, 16 * kMostPaths})
        .usually("16 times the largest count");
    list.number("--target-samples", "N",
                "times are compared at the error of the baseline with so many samples",
                asked.targetSamples, kStudySamples)
        .usually("64, or the largest count");
    list.real("--most-seconds", "S", "efforts that would take longer are left out",
              s.mostSecondsPerRun, kSeconds, kTimes);
}

void checkRange(const char* what, uint32_t value, uint32_t least, uint32_t most) {
    if (value < least || value > most)
        throw UsageError(fmt::format("{} is {}: expected {} to {}", what, value, least, most));
}

void finishCounts(const AskedStudy& asked, study::StudySettings& s) {
    for (size_t i = 1; i < s.sampleCounts.size(); ++i)
        if (s.sampleCounts[i] <= s.sampleCounts[i - 1])
            throw UsageError("-s: the sample counts must grow");
    if (s.sampleCounts.size() < 2) throw UsageError("-s: at least two sample counts are needed");
    const uint32_t fewest = s.sampleCounts.front(), largest = s.sampleCounts.back();
    s.referenceSamples = asked.referenceSamples.value_or(16 * largest);
    checkRange("--reference-samples", s.referenceSamples, largest, 16 * kMostPaths);
    s.targetSamples = asked.targetSamples.value_or(std::min(64u, largest));
    checkRange("--target-samples", s.targetSamples, fewest, largest);
}

void finishBaseline(study::StudySettings& s) {
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

void finishStudy(const AskedStudy& asked, StudyOptions& o) {
    study::StudySettings& s = o.settings;
    s.configurations = study::chooseConfigurations(asked.configurations);
    if (s.scenes.empty() && !o.list) throw UsageError("SCENE is required (see --help)");
    s.commonOptions = fmt::format("-r {} {} -m {}{}{}", asked.width, asked.height, asked.maxBounces,
                                  asked.moreOptions.empty() ? "" : " ", asked.moreOptions);
    s.referenceOptions = "--sampler independent"; // no structure that a study's runs might share
    finishCounts(asked, s);
    finishBaseline(s);
}

} // namespace

void declareStudy(DeclaredCommand& c) {
    const auto o = std::make_shared<StudyOptions>();
    const auto asked = std::make_shared<AskedStudy>();
    declareScenes(c.list, *o);
    declareConfigurations(c.list, *asked, *o);
    declareMeasuring(c.list, *asked, *o);
    declareDevice(c.list, o->device);
    declareHost(c);
    c.footer = "Errors are relMSE, the mean of (x - r)^2 / (r^2 + 0.01 m^2), r the reference and m "
               "its mean, less what the reference's own noise adds. Times are those of sampling "
               "alone.";
    c.finish = [&c, asked, o] {
        const std::string ignored =
            o->list ? c.givenOf({"SCENE", "-o", "-c", "--baseline", "--options", "--quick", "-r",
                                 "-m", "-s", "--seeds", "--reference-samples", "--target-samples",
                                 "--most-seconds", "--device", "-t"})
                    : "";
        if (!ignored.empty())
            c.host.remarks.push_back("--list measures nothing: ignored: " + ignored);
        finishStudy(*asked, *o);
        o->verbosity = c.host.verbosity;
        return *o;
    };
}

} // namespace stromboli
