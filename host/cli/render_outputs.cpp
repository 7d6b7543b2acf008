#include "host/cli/render_outputs.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/log.hpp"
#include "host/film/image_formats.hpp"
#include "host/film/shown_film.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
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
    return {options.tone, options.output.statisticsChannels, options.picture.channels()};
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

/// The statistics take no more than the estimate spares.
void checkDiskSpace(const Scene& scene, const RenderSettings& settings,
                    const RenderOptions& options) {
    const std::string& file = options.output.file;
    if (isStandardOutput(file)) return;
    const Crop part = settings.area.rendered();
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
    const ToneCurve tone = isPng(options_.output.file) ? options_.tone : ToneCurve{};
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
    picture_.write(withLegend(notes, scene_, options_));
    if (rates_) writePng(ratePicturePath(output.file), *rates_, PngColorSpace::Unnamed, notes);
    if (!output.statsFile.empty()) writeStatistics(output.statsFile, report, scene_, settings_);
}

} // namespace stromboli
