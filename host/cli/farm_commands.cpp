#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/kept_files.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/merge_films.hpp"
#include "host/farm/round_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace stromboli {

// --- plan ----------------------------------------------------------------------------------------

// `plan`: films of the rounds until now say where the samples of the next one go.

namespace {

/// The most samples of a pixel; -s counts paths.
uint32_t mostSamplesOf(const FilmHeader& header, const PlanOptions& options) {
    if (!options.mostPaths) return kMostSamples;
    const uint32_t paths = *options.mostPaths;
    const uint32_t branches = header.settings.estimator.branches;
    if (paths % branches != 0)
        throw UsageError(fmt::format("-s {} is not a multiple of the {} --branches of the films",
                                     paths, branches));
    return paths / branches;
}

void sayWhyNothingIsLeft(const PictureNoise& reached, double noise) {
    const std::string words = inWords(reached);
    if (reached.known() && reached.most <= noise)
        logging::info(fmt::format("nothing is left to do: {}; at most {} % is asked for", words,
                                  percent(noise)));
    else if (reached.unknown == PictureNoise::Unknown::Black)
        logging::info(fmt::format("nothing is left to do: {}", words));
    else
        logging::warn(fmt::format("nothing is left to do: all pixels have the samples of -s; {}, "
                                  "and at most {} % is asked for",
                                  words, percent(noise)));
}

void sayWhatIsPlanned(const NextRound& next, double noise) {
    const RoundPlan& plan = *next.plan;
    const double pixels = double(plan.from.size());
    const double paths = plan.picture.settings.estimator.branches;
    logging::info(fmt::format(
        "round {}: {} samples more, for {} of {} pixels: from {:.6g} to {:.6g} a pixel on the mean",
        plan.round(), plan.samples() * uint64_t(paths), plan.pixels(), plan.from.size(),
        paths * double(plan.picture.samplesInAll()) / pixels,
        paths * double(plan.picture.samplesInAll() + plan.samples()) / pixels));
    logging::info(
        fmt::format("{}; at most {} % is asked for", inWords(next.reached), percent(noise)));
}

} // namespace

void declarePlan(DeclaredCommand& c) {
    const auto owned = std::make_shared<PlanOptions>();
    PlanOptions& o = *owned;
    c.list.group("Films");
    c.list
        .list("FILM", "",
              "all films of the rounds until now, of render --share or merge, in any "
              "order",
              o.films)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE.plan",
              "the plan of the next round, for render --plan; nothing is written, and the exit "
              "code is 7, if nothing is left to do",
              o.file)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Sampling");
    declareNoise(c.list,
                 "the noise to reach, as of render: the square root of the picture's relMSE is at "
                 "most T (0.02: 2 %) in 95 of 100 renders",
                 o.noise)
        .required();
    c.list.number("-s,--samples", "N", "the most samples of a pixel, over all rounds", o.mostPaths,
                  {1, kMostSamples});
    declareHost(c);
    c.finish = [owned] {
        if (!namesPlan(owned->file))
            throw UsageError(
                fmt::format("{}: plan writes a plan, whose name must end in .plan", owned->file));
        return *owned;
    };
}

int planCommand(const PlanOptions& options) {
    nowDoing(fmt::format("adding up {} films", options.films.size()));
    checkFileWritable(options.file);
    FilmsToMerge films({options.films.begin(), options.films.end()});
    const double noise = options.noise;
    const NextRound next = planNextRound(films, noise, mostSamplesOf(films.header(), options));
    if (!next.plan) {
        sayWhyNothingIsLeft(next.reached, noise);
        return int(ExitCode::NothingLeft);
    }
    nowDoing("writing " + options.file);
    writePlan(options.file, *next.plan);
    sayWhatIsPlanned(next, noise);
    return 0;
}

// --- merge ---------------------------------------------------------------------------------------

// `merge`: films of shares become a picture, or a film again.

namespace {

/// The command that renders the picture in one go, with what was said when it was put together, in
/// the order in which `render` lists its options.
std::vector<std::string> wholeCommand(std::vector<std::string> command,
                                      const MergeOptions& options) {
    command.insert(command.end(), options.ofPicture.begin(), options.ofPicture.end());
    const std::deque<DeclaredCommand> commands = declareCommands();
    const auto& all = commands.front().list.all();
    const auto placeOf = [&](const std::string& part) {
        const std::string name = part.starts_with("-") ? part.substr(0, part.find(' ')) : "SCENE";
        return std::ranges::find_if(all, [&](const CommandOption& o) { return o.name() == name; }) -
               all.begin();
    };
    if (!command.empty())
        std::stable_sort(
            command.begin() + 1, command.end(),
            [&](const std::string& a, const std::string& b) { return placeOf(a) < placeOf(b); });
    return command;
}

/// "64 a pixel", as of a render in one go; of less: "48 a pixel of 64; share 2 of 4 is missing".
std::string samplesNote(const FilmHeader& film) {
    const auto paths = [&](uint64_t samples) {
        return double(samples * film.settings.estimator.branches) /
               double(film.settings.area.pixelCount());
    };
    std::string text = fmt::format("{:.6g} a pixel", paths(film.samplesHeld()));
    if (!film.isComplete()) text += fmt::format(" of {:.6g}", paths(film.samplesInAll()));
    if (film.rounds() > 1) text += fmt::format(", in {} rounds", film.rounds());
    return film.isComplete() ? text : fmt::format("{}; {}", text, missingFrom(film));
}

void writeFilm(FilmsToMerge& films, const MergeOptions& options) {
    FilmWriter writer(options.output.file, films.header());
    films.addUp(
        [&](const PictureArea&, std::span<const SharedPixel> run, std::span<const float> layers) {
            if (!films.header().isEmpty()) writer.add(run, layers);
        });
    writer.finish();
}

/// "about 2 % (95 % range: 1.5 to 2.6 %)".
std::string noteOf(const PictureNoise& noise) {
    return inWords(noise).substr(std::string_view("noise ").size());
}

/// Channels that the picture has beside its radiance.
std::vector<std::string> channelsBeside(const FilmHeader& header, const MergeOptions& options) {
    std::vector<std::string> names;
    if (header.hasAlpha()) names.emplace_back(kAlphaChannel);
    if (header.hasAlpha() && formatOf(options.output.file) == PictureFormat::Jpeg)
        throw UsageError(fmt::format("{} is a JPEG, which has no alpha, and the films have: write "
                                     ".png, .webp or .exr",
                                     options.output.file));
    if (header.layers.empty()) return names;
    if (isToneMapped(options.output.file)) {
        logging::warn(
            fmt::format("{} has no channels for the layers of the films", options.output.file));
        return names;
    }
    if (!header.holdsLayers)
        logging::warn("the layers are missing: they are in the film of the first samples");
    for (const Layer layer : header.layers)
        for (std::string& name : channelsOf(layer))
            names.push_back(std::move(name));
    return names;
}

/// Returns what is known of the picture's noise.
PictureNoise writeMergedPicture(FilmsToMerge& films, const MergeOptions& options) {
    const FilmHeader& header = films.header();
    const PictureOptions pictureOptions{options.tone, options.output.statisticsChannels,
                                        channelsBeside(header, options), options.output.encoding};
    const auto notesOf = [&](const PictureNoise& noise) {
        const PictureNotes legend =
            isToneMapped(options.output.file) ? PictureNotes{} : header.legend;
        if (!options.output.notes) return legend;
        // A picture in one round has the bytes of one render, whose notes cannot tell: the noise of
        // a render in bands or in two goes is found out in another way.
        PictureNotes notes =
            pictureNotes({header.scene, header.settings.estimator.seed, samplesNote(header),
                          header.identity.device, wholeCommand(header.command, options),
                          header.rounds() > 1 ? noteOf(noise) : ""});
        notes.insert(notes.end(), legend.begin(), legend.end());
        return notes;
    };
    const Crop part = header.settings.area.rendered();
    checkPictureSize(options.output.file, part.width, part.height);
    if (!isStandardOutput(options.output.file))
        checkFreeSpace(options.output.file,
                       largestPictureFile(options.output.file, part.width, part.height,
                                          pictureOptions, notesOf({})));
    PictureFile picture(options.output.file, header.settings.area, pictureOptions);
    std::vector<PartNoise> noises;
    PictureParts parts(
        header, [&](const Film& film, const NoiseEstimate& estimate, const FloatImage& more) {
            picture.place(film, more);
            noises.push_back({estimate.picture(film), film.pixels.size()});
        });
    films.addUp([&](const PictureArea&, std::span<const SharedPixel> run,
                    std::span<const float> layers) { parts.add(run, layers); });
    nowDoing("writing " + options.output.file);
    const PictureNoise noise = togetherOf(noises);
    sayWhatWasMetered(options.tone, picture.write(notesOf(noise)));
    return noise;
}

} // namespace

void declareMerge(DeclaredCommand& c) {
    const auto owned = std::make_shared<MergeOptions>();
    MergeOptions& o = *owned;
    c.list.group("Films");
    c.list
        .list("FILM", "",
              "films that render --share or merge wrote, in any order; or the checkpoint of a "
              "render, to see how far it is",
              o.films)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE",
              "picture to write: .png, .jpg, .webp or .exr, with the bytes that a render in one go "
              "has; or a .film, to be merged with others",
              o.output.file)
        .required()
        .proposes(Proposed::Files);
    c.list.flag("--complete", "write nothing, and fail, if shares are missing", o.wantsAllShares);
    declarePictureFile(c.list, o.output, o.tone);
    declareHost(c);
    c.finish = [&c, owned] {
        const OutputOptions& output = owned->output;
        owned->ofPicture = partsOfPictureFile(c.pictureCommand);
        if (!namesFilm(output.file)) {
            checkOutputOptions(c, output, {});
            return *owned;
        }
        const std::string ofPictures = c.givenOf(pictureFileOptions());
        if (!ofPictures.empty())
            throw UsageError(fmt::format("{}: a film has no {}: say it when the picture is made",
                                         output.file, ofPictures));
        return *owned;
    };
}

int mergeCommand(const MergeOptions& options) {
    namespace fs = std::filesystem;
    nowDoing(fmt::format("adding up {} films", options.films.size()));
    if (namesFilm(options.output.file))
        checkFileWritable(options.output.file);
    else
        checkWritable(options.output.file);
    for (const std::string& file : options.films)
        if (isKeptPicture(file)) {
            if (options.films.size() == 1) return mergeCheckpoint(file, options);
            throw UsageError(fmt::format("{}: a checkpoint is a picture of its own: merge takes "
                                         "one, or films",
                                         file));
        }
    size_t merged = options.films.size(), leftOut = 0;
    FilmsToMerge films({options.films.begin(), options.films.end()},
                       [&](const fs::path& file, const UnfinishedFilm& film) {
                           --merged, ++leftOut;
                           logging::warn(
                               fmt::format("{} {}; it is left out", file.string(), inWords(film)));
                       });
    const FilmHeader& header = films.header();
    if (!header.isComplete()) {
        const std::string missing = missingFrom(header);
        if (options.wantsAllShares)
            throw UsageError(fmt::format("{} is not written: {}", options.output.file, missing));
        if (header.blocks.empty() && !namesFilm(options.output.file))
            throw UsageError(fmt::format("{} is not written: the films have no samples{}; {}",
                                         options.output.file,
                                         header.isEmpty() ? ""
                                                          : " of the first round, which all "
                                                            "pixels have",
                                         missing));
        logging::warn(fmt::format("{}: {}", options.output.file, samplesNote(header)));
    }
    std::optional<PictureNoise> noise;
    if (namesFilm(options.output.file))
        writeFilm(films, options);
    else
        noise = writeMergedPicture(films, options);
    logging::info(fmt::format("{} films, {}", merged, samplesNote(header)));
    sayIfBiased(header.settings.estimator);
    if (noise && header.settings.estimator.integrator == Integrator::Path)
        logging::info(inWords(*noise));
    if (leftOut == 0) return 0;
    logging::warn(fmt::format("{} lacks {} of {} films: exit code {}", options.output.file, leftOut,
                              options.films.size(), int(ExitCode::TooFewSamples)));
    return int(ExitCode::TooFewSamples);
}

} // namespace stromboli
