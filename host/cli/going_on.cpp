// Checkpoints of `render`: which file, and what it means to go on from it.
#include "host/cli/going_on.hpp"

#include "host/checkpoint/band_files.hpp"
#include "host/checkpoint/scene_identity.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/render/bands.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

std::string checkpointFileOf(const Options& options) {
    if (options.checkpointFile == "off" || options.output == "-") return "";
    return options.checkpointFile.empty() ? usualCheckpointPath(options.output).string()
                                          : options.checkpointFile;
}

double meanSamples(const SessionState& state) {
    double sum = 0;
    for (const PixelSums& s : state.sums)
        sum += s.count + s.rejected;
    for (const ExactStatistics& s : state.blocks)
        sum += s.taken();
    return state.sums.empty() ? 0
                              : sum * state.settings.estimator.branches / double(state.sums.size());
}

} // namespace

Begun takeUp(const Options& options) {
    Begun begun{checkpointFileOf(options), {}, 0};
    if (!options.resume) return begun;
    if (begun.file.empty())
        throw UsageError("--resume needs a checkpoint, and --checkpoint is off");
    if (fs::exists(begun.file)) {
        begun.checkpoint = readCheckpoint(begun.file);
        return begun;
    }
    begun.bands = bandsKept(begun.file);
    if (begun.bands == 0)
        logging::warn(fmt::format("there is no {}: the render begins anew", begun.file));
    for (size_t band = 0; band < begun.bands && !begun.checkpoint; ++band)
        begun.checkpoint = begunBand(begun, band, begun.bands).checkpoint;
    return begun;
}

Options optionsToGoOn(Options options, const Begun& begun) {
    if (!begun.checkpoint) return options;
    const uint32_t branches = begun.checkpoint->state.settings.estimator.branches;
    if (!options.branches) options.branches = branches;
    const uint32_t paths = options.budget.pathsPerPixel();
    if (*options.branches == branches && paths != kMostSamples && paths % branches != 0)
        throw UsageError(fmt::format("-s {} is not a multiple of the {} --branches of {}", paths,
                                     branches, begun.file));
    return options;
}

std::vector<PictureArea> bandsToRender(const PictureArea& area, uint64_t mostPixels,
                                       const Begun& begun) {
    const std::vector<PictureArea> bands = bandsOf(area, mostPixels);
    const auto refuse = [&](const std::string& what) {
        throw UsageError(fmt::format("{}: {}", begun.file, what));
    };
    if (begun.bands == 0) {
        if (begun.checkpoint && bands.size() > 1)
            refuse("the checkpoint is of a picture in one piece, which does not fit the memory "
                   "here: give it more --film-memory");
        if (bands.size() > 1)
            logging::info(fmt::format("the film does not fit the memory: rendering {} bands, one "
                                      "after the other",
                                      bands.size()));
        return bands;
    }
    const Crop all = area.rendered();
    if (begun.bands > all.height)
        refuse(fmt::format("the checkpoints are of {} bands, and the picture has {} rows: give the "
                           "same -r and --crop",
                           begun.bands, all.height));
    // A row is rendered whether it fits or not.
    if (begun.bands < bands.size() && bands.size() < all.height)
        refuse(fmt::format("the checkpoints are of {} bands, which do not fit the memory here: "
                           "give them more --film-memory",
                           begun.bands));
    logging::info(fmt::format("rendering {} bands, one after the other, as before", begun.bands));
    return inBands(area, begun.bands);
}

Begun begunBand(const Begun& begun, size_t band, size_t count) {
    if (count == 1 || begun.file.empty()) return {begun.file, begun.checkpoint, 0};
    Begun result{bandFile(begun.file, band, count).string(), {}, begun.bands};
    if (begun.bands > 0 && fs::exists(result.file)) result.checkpoint = readCheckpoint(result.file);
    return result;
}

void forgetEarlier(const std::string& file, size_t bands) {
    removeBandFiles(file);
    std::error_code failed; // what cannot be removed does no harm
    if (bands > 1) fs::remove(file, failed);
}

KeptRender keptRender(const Job& job, const RenderSettings& settings, const Options& options,
                      const Begun& begun, const std::string& device) {
    KeptRender render;
    const auto identity = [&job, scene = job.scene.file, backend = nameOf(options.backend),
                           device] {
        return RenderIdentity{version(), renderingCode(),
                              scene,     sceneIdentity(job.scene, job.camera),
                              backend,   device};
    };
    render.identity = identity;
    render.settings = settings;
    render.file = begun.file;
    render.everySeconds = options.checkpointSeconds;
    render.keepsAtEnd = !options.checkpointFile.empty() && !begun.file.empty();
    if (!begun.checkpoint) return render;

    requireSameRender(begun.file, *begun.checkpoint, identity(), settings);
    if (begun.checkpoint->identity.device != device)
        logging::warn(fmt::format("{} was begun on {}: pictures agree, their bytes need not",
                                  begun.file, begun.checkpoint->identity.device));
    render.begun = withBudget(begun.checkpoint->state, settings.budget);
    logging::info(fmt::format("goes on from {}, which has {:.1f} samples a pixel", begun.file,
                              meanSamples(*render.begun)));
    return render;
}

} // namespace stromboli
