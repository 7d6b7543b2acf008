// `merge`: films of shares become a picture, or a film again.
#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/output.hpp"
#include "host/farm/merge_films.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace stromboli {
namespace {

/// The command that renders the picture in one go, with what was said when it was put together, in
/// the order in which `render` lists its options.
std::vector<std::string> wholeCommand(std::vector<std::string> command, const Options& options) {
    if (options.tone.exposure != 0)
        command.push_back(fmt::format("--exposure {}", options.tone.exposure));
    if (options.statisticsChannels) command.emplace_back("--aov");
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
    const uint64_t branches = film.settings.estimator.branches;
    const std::string held = fmt::format("{:.6g} a pixel", double(film.samples() * branches));
    if (film.isComplete()) return held;
    return fmt::format("{} of {}; {}", held, film.allBlocks().samples * branches,
                       missingFrom(film));
}

void writeFilm(FilmsToMerge& films, const Options& options) {
    FilmWriter writer(options.output, films.header());
    films.addUp([&](const PictureArea&, std::span<const ExactStatistics> run) {
        if (!films.header().blocks.empty()) writer.add(run);
    });
    writer.finish();
}

void writeMergedPicture(FilmsToMerge& films, const Options& options) {
    const FilmHeader& header = films.header();
    const PictureOptions pictureOptions{options.tone, options.statisticsChannels, {}};
    PictureNotes notes;
    if (options.notes)
        notes = pictureNotes({header.scene, header.settings.estimator.seed, samplesNote(header),
                              header.identity.device, wholeCommand(header.command, options)});
    const Crop part = header.settings.area.rendered();
    if (!isStandardOutput(options.output))
        checkFreeSpace(options.output, largestPictureFile(options.output, part.width, part.height,
                                                          pictureOptions, notes));
    PictureFile picture(options.output, header.settings.area, pictureOptions);
    films.addUp([&](const PictureArea& rows, std::span<const ExactStatistics> run) {
        Film film(rows);
        film.branches = header.settings.estimator.branches;
        for (size_t i = 0; i < run.size(); ++i)
            film.pixels[i] = run[i].statistics();
        picture.place(film);
    });
    nowDoing("writing " + options.output);
    picture.write(notes);
}

} // namespace

int mergeCommand(const Options& options) {
    nowDoing(fmt::format("adding up {} films", options.films.size()));
    if (namesFilm(options.output))
        checkFileWritable(options.output);
    else
        checkWritable(options.output);
    FilmsToMerge films({options.films.begin(), options.films.end()});
    const FilmHeader& header = films.header();
    if (!header.isComplete()) {
        const std::string missing = missingFrom(header);
        if (options.wantsAllShares)
            throw UsageError(fmt::format("{} is not written: {}", options.output, missing));
        if (header.blocks.empty() && !namesFilm(options.output))
            throw UsageError(fmt::format("{} is not written: the films have no samples; {}",
                                         options.output, missing));
        logging::warn(fmt::format("{}: {}", options.output, samplesNote(header)));
    }
    if (namesFilm(options.output))
        writeFilm(films, options);
    else
        writeMergedPicture(films, options);
    logging::info(fmt::format("{} films, {}", options.films.size(), samplesNote(header)));
    return 0;
}

} // namespace stromboli
