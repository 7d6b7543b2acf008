// Checkpoints of `render`: which file, and what it means to go on from it.
#include "host/cli/going_on.hpp"

#include "host/checkpoint/scene_identity.hpp"
#include "host/core/checksum.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
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
    return state.sums.empty() ? 0
                              : sum * state.settings.estimator.branches / double(state.sums.size());
}

} // namespace

Begun takeUp(const Options& options) {
    Begun begun{checkpointFileOf(options), {}};
    if (!options.resume) return begun;
    if (begun.file.empty())
        throw UsageError("--resume needs a checkpoint, and --checkpoint is off");
    if (!fs::exists(begun.file)) {
        logging::warn(fmt::format("there is no {}: the render begins anew", begun.file));
        return begun;
    }
    begun.checkpoint = readCheckpoint(begun.file);
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

void sayBands(size_t bands, const Options& options, const Begun& begun) {
    if (begun.checkpoint || (!options.checkpointFile.empty() && options.checkpointFile != "off"))
        throw UsageError(fmt::format("the film does not fit the memory, and a picture in bands "
                                     "({} here) keeps no checkpoint: leave out --checkpoint and "
                                     "--resume, or give it more --film-memory",
                                     bands));
    logging::info(fmt::format("the film does not fit the memory: rendering {} bands, one after the "
                              "other, without checkpoints",
                              bands));
}

KeptRender keptRender(const Job& job, const RenderSettings& settings, const Options& options,
                      const Begun& begun, const std::string& device) {
    KeptRender render;
    const auto identity = [&job, scene = job.scene.file, backend = nameOf(options.backend),
                           device] {
        return RenderIdentity{fmt::format("{} {:08x}", version(), checksumOfFile("/proc/self/exe")),
                              scene, sceneIdentity(job.scene, job.camera), backend, device};
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
