#include "host/cli/render_outputs.hpp"

#include "host/cli/seen_channels.hpp"

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/output.hpp"
#include "host/core/printable.hpp"
#include "host/film/png.hpp"
#include "host/film/rate_picture.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

/// Whether a picture of its own shows how many samples each pixel has. Where they are spread
/// without being asked to, it would be a file that nobody asked for.
template <class AnyBudget>
bool writesRates(const Options& options, const AnyBudget& budget) {
    return !isStandardOutput(options.output) && (budget.adaptive.enabled || budget.stop.open());
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
PictureNotes notesOf(const Job& job, const Options& options, const std::string& device,
                     const std::string& samples) {
    if (!options.notes) return {};
    return pictureNotes(
        {options.scene, job.settings.estimator.seed, samples, device, options.pictureCommand, ""});
}

PictureOptions pictureOptions(const Options& options) {
    return {options.tone, options.statisticsChannels, seenChannelNames(options)};
}

/// With what says what the channels mean.
PictureNotes withLegend(PictureNotes notes, const Job& job, const Options& options) {
    for (PictureNote& note : legendOf(options.layers, job.scene))
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

void checkOutputs(const Options& options) {
    if (options.share)
        checkFileWritable(options.output);
    else
        checkWritable(options.output);
    if (writesRates(options, options.budget)) checkOutputWritable(ratePicturePath(options.output));
    if (options.statsFile.empty()) return;
    if (options.statsFile == options.output)
        throw UsageError("--stats and -o name the same file: " + options.output);
    if (writesRates(options, options.budget) &&
        options.statsFile == ratePicturePath(options.output))
        throw UsageError("--stats names the file of the rate picture: " + options.statsFile);
    checkOutputWritable(options.statsFile);
}

/// The statistics take no more than the estimate spares.
void checkDiskSpace(const Job& job, const Options& options) {
    if (isStandardOutput(options.output)) return;
    const Crop part = job.settings.area.rendered();
    const PictureNotes notes = notesOf(job, options, "", "");
    uint64_t bytes = largestPictureFile(options.output, part.width, part.height,
                                        pictureOptions(options), withLegend(notes, job, options));
    if (writesRates(options, job.settings.budget))
        bytes +=
            largestPictureFile(ratePicturePath(options.output), part.width, part.height, {}, notes);
    checkFreeSpace(options.output, bytes);
}

RenderOutputs::RenderOutputs(const Job& job, const Options& options)
    : job_(job), options_(options),
      picture_(options.output, job.settings.area, pictureOptions(options)) {}

void RenderOutputs::place(const Film& film, const PictureNoise& noise, const FloatImage& more) {
    picture_.place(film, more);
    noises_.push_back({noise, film.pixels.size()});
    const ToneCurve tone = isPng(options_.output) ? options_.tone : ToneCurve{};
    brightness_.push_back({brightnessOf(film, tone), film.pixels.size()});
    if (writesRates(options_, job_.settings.budget) &&
        film.pixels.size() == job_.settings.area.pixelCount())
        rates_ = ratePicture(film, mostSamples(film, job_.settings.budget));
}

void RenderOutputs::leaveOut(const PictureArea& band) {
    noises_.push_back({{}, band.pixelCount()});
}

void RenderOutputs::write(const RenderReport& report) const {
    const double samples = double(report.samplesTaken) / double(job_.settings.area.pixelCount());
    const PictureNotes notes =
        notesOf(job_, options_, report.backend, fmt::format("{:.6g} a pixel", samples));
    picture_.write(withLegend(notes, job_, options_));
    if (rates_) writePng(ratePicturePath(options_.output), *rates_, PngColorSpace::Unnamed, notes);
    if (!options_.statsFile.empty()) writeStatistics(options_.statsFile, report, job_);
}

} // namespace stromboli
