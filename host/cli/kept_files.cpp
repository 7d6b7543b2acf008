// What checkpoints and films say of renders that may still go on.
#include "host/cli/kept_files.hpp"

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/core/printable.hpp"
#include "host/engine/render_request.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/unfinished_film.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/kept_film.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// How far a render is.
struct Kept {
    std::string file, kind, scene, device, program;
    uint32_t width = 0, height = 0; ///< of the part that it is of
    double samples = 0, atMost = 0; ///< paths of a pixel, on the mean
    std::string missing;            ///< of a film; empty: nothing
    std::optional<UnfinishedFilm> unfinished;
    std::optional<PictureNoise> noise;
};

/// Paths of a pixel, on the mean.
double meanPaths(const Film& film) {
    double sum = 0;
    for (const PixelStatistics& pixel : film.pixels)
        sum += pixel.taken();
    return sum * film.branches / double(std::max<size_t>(film.pixels.size(), 1));
}

double pathsAtMost(const RenderSettings& settings) {
    return double(mostPathsOf(settings)) / double(settings.area.pixelCount());
}

void describe(Kept& kept, const RenderIdentity& identity, const RenderSettings& settings) {
    const Crop part = settings.area.rendered();
    kept.scene = identity.scene, kept.device = identity.device, kept.program = identity.program;
    kept.width = part.width, kept.height = part.height;
}

Kept ofCheckpoint(const std::string& file) {
    const Checkpoint checkpoint = readCheckpoint(file);
    Kept kept{.file = file, .kind = "checkpoint"};
    describe(kept, checkpoint.identity, checkpoint.state.settings);
    const Film film = filmOf(checkpoint.state);
    kept.samples = meanPaths(film);
    kept.atMost = pathsAtMost(checkpoint.state.settings);
    kept.noise = noiseOf(checkpoint.state, film);
    return kept;
}

Kept ofFilm(const std::string& file) {
    Kept kept{.file = file, .kind = "film"};
    kept.unfinished = unfinishedFilm(file);
    if (kept.unfinished) return kept;
    const FilmReader reader(file);
    const FilmHeader& header = reader.header();
    describe(kept, header.identity, header.settings);
    const double paths =
        double(header.settings.estimator.branches) / double(header.settings.area.pixelCount());
    kept.samples = double(header.samplesHeld()) * paths;
    kept.atMost = double(header.samplesInAll()) * paths;
    if (!header.isComplete()) kept.missing = missingFrom(header);
    return kept;
}

/// The checkpoint itself, or those of its bands that there are. Throws UsageError if there is none.
std::vector<std::string> checkpointsOf(const std::string& file) {
    if (fs::exists(file)) return {file};
    std::vector<std::string> bands;
    const uint32_t count = bandsKept(file);
    for (uint32_t band = 0; band < count; ++band)
        if (std::string one = bandFile(file, band, count).string(); fs::exists(one))
            bands.push_back(std::move(one));
    if (bands.empty())
        throw UsageError(fmt::format("{}: there is none: no checkpoint was written yet, or the "
                                     "render is finished",
                                     file));
    return bands;
}

std::vector<Kept> allOf(const std::string& file) {
    if (namesFilm(file)) return {ofFilm(file)};
    std::vector<Kept> all;
    for (const std::string& one : checkpointsOf(file))
        all.push_back(ofCheckpoint(one));
    return all;
}

Json jsonOf(const Kept& kept) {
    Json json = {{"file", printable(kept.file)}, {"kind", kept.kind}};
    if (kept.unfinished) {
        json["isComplete"] = false;
        json["rows"] = kept.unfinished->rows;
        json["allRows"] = kept.unfinished->allRows;
        return json;
    }
    json["isComplete"] = true;
    json["scene"] = printable(kept.scene);
    json["device"] = printable(kept.device);
    json["program"] = printable(kept.program);
    json["width"] = kept.width;
    json["height"] = kept.height;
    json["samples"] = kept.samples;
    json["samplesAtMost"] = kept.atMost;
    json["missing"] = kept.missing;
    if (kept.noise && kept.noise->known())
        json["noise"] = {{"estimate", kept.noise->estimate},
                         {"least", kept.noise->least},
                         {"most", kept.noise->most}};
    return json;
}

void print(const Kept& kept) {
    if (kept.unfinished)
        return fmt::print("film {}: {}\n", printable(kept.file), inWords(*kept.unfinished));
    fmt::print("{} {}: {:.6g} samples a pixel of at most {:.6g}\n", kept.kind, printable(kept.file),
               kept.samples, kept.atMost);
    fmt::print("  {} x {} pixels of {}, on {}, by {}\n", kept.width, kept.height,
               printable(kept.scene), printable(kept.device), printable(kept.program));
    if (!kept.missing.empty()) fmt::print("  {}\n", kept.missing);
    if (kept.noise) fmt::print("  {}\n", inWords(*kept.noise));
}

} // namespace

bool isKeptRender(const std::string& file) {
    return namesFilm(file) || isCheckpoint(file) || file.ends_with(".checkpoint") ||
           file.find(".checkpoint.band") != std::string::npos;
}

bool isKeptPicture(const std::string& file) {
    return isCheckpoint(file) || (!namesFilm(file) && !fs::exists(file) && bandsKept(file) > 0);
}

int infoOfKeptRender(const std::string& file, const std::string& jsonFile) {
    const std::vector<Kept> all = allOf(file);
    nowDoing("printing", StatusLine::OfOthers);
    if (!jsonFile.empty()) {
        Json json = Json::array();
        for (const Kept& kept : all)
            json.push_back(jsonOf(kept));
        writeOutput(jsonFile, json.dump(2) + "\n");
        return 0;
    }
    for (const Kept& kept : all)
        print(kept);
    return 0;
}

namespace {

/// The picture that bands are of: those that no checkpoint is of yet are known to be there where
/// the picture has no crop.
PictureArea wholeOf(const std::string& file, const std::vector<std::string>& files,
                    const std::vector<PictureArea>& bands) {
    if (bands.size() == 1 && files.front() == file) return bands.front();
    const PictureArea whole{bands.front().width, bands.front().height, {}};
    const uint32_t count = bandsKept(file);
    if (count <= whole.height) {
        const std::vector<PictureArea> all = inBands(whole, count);
        const auto isOne = [&](const PictureArea& band) {
            return std::ranges::any_of(all, [&](const auto& b) { return sameArea(b, band); });
        };
        if (std::ranges::all_of(bands, isOne)) return whole;
    }
    const Crop first = bands.front().rendered(), last = bands.back().rendered();
    return {
        whole.width, whole.height, {first.x, first.y, first.width, last.y + last.height - first.y}};
}

/// What of all pixels of a render its checkpoints hold.
struct KeptPicture {
    std::vector<Film> films;
    std::vector<PartNoise> noises;
    RenderIdentity identity;
    Estimator estimator;
    PictureArea area;
    double paths = 0, pathsAtMost = 0; ///< of a pixel, on the mean
    bool isFinished = true;

    std::string samples() const {
        std::string text = fmt::format("{:.6g} a pixel of at most {:.6g}", paths, pathsAtMost);
        return isFinished ? text : text + "; the render is not finished";
    }
};

/// By its samples, or by the noise that was asked for; what a limit of time has ended is not known
/// to be finished.
bool isFinished(const RenderSettings& settings, double paths, const PictureNoise& noise) {
    const double asked = settings.budget.stop.noise;
    return paths >= pathsAtMost(settings) * (1 - 1e-9) ||
           (asked > 0 && noise.known() && noise.most <= asked);
}

KeptPicture pictureOf(const std::string& file) {
    const std::vector<std::string> files = checkpointsOf(file);
    KeptPicture all;
    std::vector<PictureArea> bands;
    double pathsInAll = 0, mostInAll = 0;
    uint64_t pixels = 0;
    for (const std::string& one : files) {
        const auto [identity, state] = readCheckpoint(one);
        if (!bands.empty() && (identity.sceneSum != all.identity.sceneSum ||
                               state.settings.area.width != bands.front().width ||
                               state.settings.area.height != bands.front().height))
            throw UsageError(fmt::format("{} is of another render than {}", one, files.front()));
        Film film = filmOf(state);
        const PictureNoise noise = noiseOf(state, film);
        const double paths = meanPaths(film);
        const uint64_t count = film.pixels.size();
        all.isFinished = all.isFinished && isFinished(state.settings, paths, noise);
        pathsInAll += paths * double(count);
        mostInAll += pathsAtMost(state.settings) * double(count);
        pixels += count;
        showNeighbours(film, NoisePlan::kCoarsest);
        all.noises.push_back({noise, count});
        all.films.push_back(std::move(film));
        bands.push_back(state.settings.area);
        all.identity = identity;
        all.estimator = state.settings.estimator;
    }
    all.area = wholeOf(file, files, bands);
    const uint64_t missing = all.area.pixelCount() - pixels;
    if (missing > 0) all.noises.push_back({{}, missing});
    all.isFinished = all.isFinished && (files.front() == file || files.size() == bandsKept(file));
    all.paths = pathsInAll / double(all.area.pixelCount());
    all.pathsAtMost = mostInAll / double(pixels);
    return all;
}

} // namespace

int mergeCheckpoint(const std::string& file, const MergeOptions& options) {
    if (namesFilm(options.output.file))
        throw UsageError(fmt::format("{}: a checkpoint becomes a picture, not a film", file));
    const KeptPicture kept = pictureOf(file);
    if (options.wantsAllShares && !kept.isFinished)
        throw UsageError(fmt::format("{} is not written: {}", options.output.file, kept.samples()));
    if (!kept.estimator.showsBackdrop)
        logging::warn(fmt::format("{} has nothing of what is seen behind objects: alpha, "
                                  "--background and shadows are missing",
                                  file));
    sayIfBiased(kept.estimator);
    const PictureNoise noise = togetherOf(kept.noises);
    PictureNotes notes;
    if (options.output.notes)
        notes = pictureNotes({kept.identity.scene,
                              kept.estimator.seed,
                              kept.samples(),
                              kept.identity.device,
                              {},
                              inWords(noise)});
    nowDoing("writing " + options.output.file);
    PictureFile picture(
        options.output.file, kept.area,
        {options.tone, options.output.statisticsChannels, {}, options.output.encoding});
    for (const Film& film : kept.films)
        picture.place(film);
    sayWhatWasMetered(options.tone, picture.write(notes));
    logging::info(fmt::format("{}: {}", file, kept.samples()));
    if (kept.estimator.integrator == Integrator::Path) logging::info(inWords(noise));
    return 0;
}

} // namespace stromboli
