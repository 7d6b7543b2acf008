#include "host/cli/render_outputs.hpp"

#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/json.hpp"
#include "host/core/printable.hpp"
#include "host/film/image_formats.hpp"
#include "host/version/version.hpp"
#include "scene/model/emitters.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli {

// --- Reports -------------------------------------------------------------------------------------

std::string percent(double share) {
    const double p = 100 * share;
    return fmt::format("{:.{}f}", p, p >= 10 ? 0 : p >= 1 ? 1 : p >= 0.1 ? 2 : 3);
}

std::string inWords(const PictureNoise& noise) {
    switch (noise.unknown) {
    case PictureNoise::Unknown::No:
        return fmt::format("noise about {} % (95 % range: {} to {} %)", percent(noise.estimate),
                           percent(noise.least), percent(noise.most));
    case PictureNoise::Unknown::TooFewSamples:
        return "noise unknown: it takes two samples a pixel to tell";
    case PictureNoise::Unknown::Black:
        return "noise unknown: no sample has met light";
    case PictureNoise::Unknown::TooFewPixels:
        return "noise unknown: nearly all of it is that of one or two pixels";
    }
    return {};
}

std::string worstPixelsInWords(const PictureNoise& noise, bool isDenoised) {
    constexpr double kMost = 0.5;
    if (!noise.known() || noise.ofWorst < kMost) return {};
    return fmt::format(
        "{} of the pixels have {} % of its square (fireflies); without them the noise "
        "is about {} %{}",
        noise.worstPixels, percent(noise.ofWorst),
        percent(noise.estimate * std::sqrt(1 - noise.ofWorst)),
        isDenoised ? "" : ": --denoise spreads them, --clamp-indirect limits them");
}

namespace {

/// Where a denoiser works the limit is one of its picture's error; the noisy one may reach it
/// first, whose range is narrower in small pictures.
void logNoise(const RenderResult& r, const StopRule& stop) {
    const auto isReached = [&](const PictureNoise& noise) {
        return noise.known() && noise.most <= stop.noise;
    };
    const std::string reached = inWords(r.noise);
    const char* const atMost = r.denoised ? "of the denoised picture at most" : "at most";
    if (stop.noise == 0)
        logging::info(reached);
    else if (isReached(r.noise) || (r.denoised && isReached(r.denoised->noise)))
        logging::info(
            fmt::format("{}; {} {} % was asked for", reached, atMost, percent(stop.noise)));
    else
        logging::warn(fmt::format("{}; {} {} % was asked for, but {} ended the render", reached,
                                  atMost, percent(stop.noise),
                                  r.cancelled ? "the interruption" : "--time or -s"));
    if (const std::string worst = worstPixelsInWords(r.noise, r.denoised.has_value());
        !worst.empty())
        logging::info(worst);
}

} // namespace

void logDenoised(const denoise::Summary& s) {
    if (!s.hasLayers)
        logging::warn(
            "albedo, normals or depth are not known: edges without noise of their own are "
            "blurred more (render --layers albedo,normal,depth)");
    if (s.noise.known())
        logging::info(fmt::format("denoised: error about {} % (95 % range: {} to {} %); the noisy "
                                  "picture has a share of {} %",
                                  percent(s.noise.estimate), percent(s.noise.least),
                                  percent(s.noise.most), percent(s.noisyShare)));
    else
        logging::info("denoised: its error is not known");
    if (s.limitedPixels > 0)
        logging::info(
            fmt::format("{} pixels rested on single samples, whose light was spread: {} % "
                        "of all light was moved",
                        s.limitedPixels, percent(s.movedLight)));
    if (s.unknownPixels > 0)
        logging::warn(fmt::format("{} pixels were no numbers or had no samples, and show what is "
                                  "around them",
                                  s.unknownPixels));
}

void sayIfBiased(const Estimator& estimator) {
    if (estimator.limitsLight())
        logging::warn("--clamp-indirect removes light: the picture is biased");
}

void logReport(const RenderReport& report, const RenderSettings& settings) {
    const RenderResult& r = report.render;
    const double rate = double(r.counters.rays) * 1e-6 / std::max(r.renderSeconds, 1e-9);
    logging::info(fmt::format("{}: {} ({} to load, {} to build the BVH, {} to "
                              "prepare, {} to write)",
                              r.backend, formatDuration(r.renderSeconds),
                              formatDuration(report.loadSeconds), formatDuration(r.buildSeconds),
                              formatDuration(r.prepareSeconds),
                              formatDuration(report.writeSeconds)));
    const std::string share = // of a number that nobody chose it says nothing
        settings.budget.spreads() || r.samplesAtMost == 0
            ? ""
            : fmt::format(" ({:.1f} % of the most)",
                          100.0 * double(r.samplesTaken) / double(r.samplesAtMost));
    logging::info(fmt::format("{} paths, {} rays, {:.2f} Mrays/s; {} samples{}, {} rejected",
                              r.counters.paths * settings.estimator.branches, r.counters.rays, rate,
                              r.samplesTaken, share, r.samplesRejected));
    if (r.pixelsUnreached > 0)
        logging::warn(fmt::format("{} of {} pixels have no sample ({}); they show a neighbour that "
                                  "has, or black",
                                  r.pixelsUnreached, settings.area.pixelCount(),
                                  r.cancelled ? "interrupted" : "--time is too short for more"));
    if (settings.estimator.integrator == Integrator::Path && !report.isShare)
        logNoise(r, settings.budget.stop);
    if (r.denoised) logDenoised(*r.denoised);
    sayIfBiased(settings.estimator);
    if (!r.firstRejected) return;
    logging::warn(fmt::format(
        "{} samples were not finite, negative or too large and were left out; to see the "
        "first, add --pixel {} {} --sample {} to the command",
        r.samplesRejected, r.firstRejected->x, r.firstRejected->y, r.firstRejected->sample));
}

void logBrightness(const Brightness& b, const Scene& scene, const std::string& file,
                   const ToneMapping& tone) {
    if (b.unlit) {
        const size_t lights = scene.lights.size() + collectEmitters(scene).size();
        logging::warn(fmt::format(
            "the picture is black: no path met light ({}); the camera may be inside an object or "
            "look past the scene (--camera frame), or the light may be cut off (-m)",
            lights == 0 ? "the scene has none"
                        : fmt::format("lights and emitting surfaces: {}", lights)));
        return;
    }
    if (!isToneMapped(file)) return; // it keeps all radiances
    if (tone.metersExposure) return; // it is as bright as it can be
    if (b.darkShare == 1)
        logging::warn(fmt::format("the picture is so dark that all of it is black in 8 bits: "
                                  "--exposure auto (about {:.0f}), or write an .exr file",
                                  *b.exposure));
    else if (b.darkShare > 0.9)
        logging::warn(fmt::format(
            "{:.1f} % of the pixels are black: {}", 100 * b.darkShare,
            *b.exposure >= 1
                ? fmt::format("--exposure auto (about {:.0f}), or write an .exr file", *b.exposure)
                : "little light reaches what is seen (--env evening_sky lights it, --camera frame "
                  "shows the whole scene)"));
    else if (b.whiteShare > 0.5 && tone.view == View::Standard)
        logging::warn(fmt::format("{:.0f} % of the pixels are brighter than white: --exposure auto "
                                  "(about {:.1f}), or write an .exr file",
                                  100 * b.whiteShare, *b.exposure));
}

void sayWhatWasMetered(const ToneMapping& asked, const ToneMapping& found) {
    const std::string text = metered(asked, found);
    if (!text.empty()) logging::info(fmt::format("{} (metered)", text));
}

void writeStatistics(const std::string& file, const RenderReport& report, const Scene& scene,
                     const RenderSettings& s) {
    const RenderResult& r = report.render;
    Json json = {
        {"version", version()},
        {"scene", scene.file},
        {"backend", r.backend},
        {"complete", r.complete()},
        {"pixels", s.area.pixelCount()},
        {"pixelsWithoutSamples", r.pixelsUnreached},
        {"width", s.area.width},
        {"height", s.area.height},
        {"samplesPerPixel",
         s.estimator.branches * (s.budget.meanSamplesPerPixel > 0 ? s.budget.meanSamplesPerPixel
                                                                  : s.budget.mostSamplesPerPixel)},
        {"branches", s.estimator.branches},
        {"spread", s.budget.spreads() || s.budget.adaptive.enabled ? "by noise" : "even"},
        {"maxBounces", s.estimator.maxBounces},
        {"seed", s.estimator.seed},
        {"clampIndirect", s.estimator.indirectLimit},
        {"sampler", nameOf(s.estimator.sampler)},
        {"triangles", scene.triangles.size()},
        {"spheres", scene.spheres.size()},
        {"seconds",
         {{"load", report.loadSeconds},
          {"build", r.buildSeconds},
          {"prepare", r.prepareSeconds},
          {"render", r.renderSeconds}}},
        {"paths", r.counters.paths * s.estimator.branches},
        {"rays", r.counters.rays},
        {"raysPerSecond", double(r.counters.rays) / std::max(r.renderSeconds, 1e-9)},
        {"samplesTaken", r.samplesTaken},
        {"samplesAtMost", r.samplesAtMost},
        {"samplesRejected", r.samplesRejected},
        {"noise", r.noise.known() ? Json(r.noise.estimate) : Json()},
        {"noiseRange", r.noise.known() ? Json(std::array{r.noise.least, r.noise.most}) : Json()},
        {"worstPixels", r.noise.known() ? Json(r.noise.worstPixels) : Json()},
        {"noiseOfWorstPixels", r.noise.known() ? Json(r.noise.ofWorst) : Json()},
    };
    if (r.denoised) {
        const denoise::Summary& d = *r.denoised;
        json["denoised"] = {{"noise", d.noise.known() ? Json(d.noise.estimate) : Json()},
                            {"noiseRange", d.noise.known()
                                               ? Json(std::array{d.noise.least, d.noise.most})
                                               : Json()},
                            {"noisyShare", d.noisyShare},
                            {"limitedPixels", d.limitedPixels},
                            {"movedLight", d.movedLight}};
    }
    if (report.isShare)
        json["seconds"]["write"] = report.writeSeconds; // of pictures it is still to come
    writeOutput(file, json.dump(4) + "\n");
}

// --- Files ---------------------------------------------------------------------------------------

namespace {

/// Whether a picture of its own shows how many samples each pixel has. Where they are spread
/// without being asked to, it would be a file that nobody asked for.
template <class AnyBudget>
bool writesRates(const OutputOptions& output, const AnyBudget& budget) {
    return !isStandardOutput(output.file) && (budget.adaptive.enabled || budget.stop.open());
}

/// What the rate picture shows as full.
uint32_t mostSamples(const Film& film, const Budget& budget) {
    if (!budget.stop.open()) return budget.mostSamplesPerPixel;
    uint32_t most = 1;
    for (const PixelStatistics& p : film.pixels)
        most = std::max(most, p.taken());
    return most;
}

/// samples: paths a pixel, on the mean.
PictureNotes notesOf(const RenderSettings& settings, const RenderOptions& options,
                     const std::string& device, const std::string& samples) {
    if (!options.output.notes) return {};
    return pictureNotes(
        {options.scene.source, settings.estimator.seed, samples, device, options.command, ""});
}

PictureOptions pictureOptions(const RenderOptions& options) {
    return {options.tone, options.output.statisticsChannels, options.picture.channels(),
            options.output.encoding};
}

/// Adds what says what the numbers in the channels mean.
PictureNotes withLegend(PictureNotes notes, const Scene& scene, const RenderOptions& options) {
    for (PictureNote& note : legendOf(options.picture.layers, scene))
        notes.push_back({note.name, printable(note.text)});
    return notes;
}

} // namespace

PictureNotes pictureNotes(const PictureOrigin& origin) {
    PictureNotes notes = {{"Software", fmt::format("Stromboli {}", version())},
                          {"Scene", printable(origin.scene)},
                          {"Seed", std::to_string(origin.seed)},
                          {"Samples", origin.samples}};
    if (!origin.noise.empty()) notes.push_back({"Noise", origin.noise});
    notes.push_back({"Device", printable(origin.device)});
    notes.push_back({"Command", printable(fmt::format("{}", fmt::join(origin.command, " ")))});
    return notes;
}

void checkOutputs(const RenderOptions& options) {
    const OutputOptions& output = options.output;
    const bool hasRates = writesRates(output, options.picture.budget);
    if (options.share.share)
        checkFileWritable(output.file);
    else
        checkWritable(output.file);
    if (hasRates) checkOutputWritable(ratePicturePath(output.file));
    if (output.statsFile.empty()) return;
    if (output.statsFile == output.file)
        throw UsageError("--stats and -o name the same file: " + output.file);
    if (hasRates && output.statsFile == ratePicturePath(output.file))
        throw UsageError("--stats names the file of the rate picture: " + output.statsFile);
    checkOutputWritable(output.statsFile);
}

/// Also whether the kind of file holds so many pixels. The statistics take no more than the
/// estimate spares.
void checkDiskSpace(const Scene& scene, const RenderSettings& settings,
                    const RenderOptions& options) {
    const std::string& file = options.output.file;
    const Crop part = settings.area.rendered();
    checkPictureSize(file, part.width, part.height);
    if (isStandardOutput(file)) return;
    const PictureNotes notes = notesOf(settings, options, "", "");
    uint64_t bytes = largestPictureFile(file, part.width, part.height, pictureOptions(options),
                                        withLegend(notes, scene, options));
    if (writesRates(options.output, settings.budget))
        bytes += largestPictureFile(ratePicturePath(file), part.width, part.height, {}, notes);
    checkFreeSpace(file, bytes);
}

RenderOutputs::RenderOutputs(const Scene& scene, const RenderSettings& settings,
                             const RenderOptions& options)
    : scene_(scene), settings_(settings), options_(options),
      picture_(options.output.file, settings.area, pictureOptions(options)) {}

void RenderOutputs::place(const FinishedBand& band) {
    const Film& film = band.film;
    picture_.place(film, band.beside);
    const ToneCurve tone = isToneMapped(options_.output.file) ? options_.tone.curve : ToneCurve{};
    brightness_.push_back({brightnessOf(film, tone), film.pixels.size()});
    if (writesRates(options_.output, settings_.budget) &&
        film.pixels.size() == settings_.area.pixelCount())
        rates_ = ratePicture(film, mostSamples(film, settings_.budget));
}

void RenderOutputs::write(const RenderReport& report) const {
    const double samples = double(report.render.samplesTaken) / double(settings_.area.pixelCount());
    const PictureNotes notes =
        notesOf(settings_, options_, report.render.backend, fmt::format("{:.6g} a pixel", samples));
    const OutputOptions& output = options_.output;
    sayWhatWasMetered(options_.tone, picture_.write(withLegend(notes, scene_, options_)));
    if (rates_) writePng(ratePicturePath(output.file), *rates_, PngColorSpace::Unnamed, notes);
    if (!output.statsFile.empty()) writeStatistics(output.statsFile, report, scene_, settings_);
}

} // namespace stromboli
