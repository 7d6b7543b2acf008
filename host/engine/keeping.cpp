// Checkpoints of renders: which file, and what it means to go on from it.
#include "host/engine/keeping.hpp"

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/error.hpp"
#include "host/render/block_backend.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

double meanSamples(const SessionState& state) {
    double sum = 0;
    for (size_t i = 0; i < state.pixels.count(); ++i)
        sum += state.pixels.statistics(i).taken();
    for (const ExactStatistics& s : state.blocks)
        sum += s.taken();
    const auto pixels = double(state.settings.area.pixelCount());
    return sum * state.settings.estimator.branches / pixels;
}

} // namespace

Keeping takeUp(Keeping keeping, const Listener& listener) {
    if (fs::exists(keeping.file)) {
        keeping.begun = readCheckpoint(keeping.file);
        return keeping;
    }
    keeping.bands = bandsKept(keeping.file);
    if (keeping.bands == 0)
        listener.warn(fmt::format("there is no {}: the render begins anew", keeping.file));
    for (size_t band = 0; band < keeping.bands && !keeping.begun; ++band)
        keeping.begun = keepingOfBand(keeping, band, keeping.bands).begun;
    return keeping;
}

RenderRequest toGoOn(RenderRequest request, const Keeping& keeping) {
    if (!keeping.begun) return request;
    const Estimator& begun = keeping.begun->state.settings.estimator;
    const uint32_t branches = begun.branches;
    if (!request.branches) request.branches = branches;
    if (request.guiding == Guiding::Automatic)
        request.guiding = begun.guidesLight ? Guiding::On : Guiding::Off;
    if (request.portals == PortalUse::Automatic)
        request.portals = begun.aimsAtPortals ? PortalUse::On : PortalUse::Off;
    const uint32_t paths = request.budget.pathsPerPixel();
    if (*request.branches == branches && paths != kMostSamples && paths % branches != 0)
        throw UsageError(fmt::format("-s {} is not a multiple of the {} --branches of {}", paths,
                                     branches, keeping.file));
    return request;
}

std::vector<PictureArea> bandsToRender(const PictureArea& area, uint64_t mostPixels,
                                       const Keeping& keeping, const Listener& listener) {
    const std::vector<PictureArea> bands = bandsOf(area, mostPixels);
    const auto refuse = [&](const std::string& what) {
        throw UsageError(fmt::format("{}: {}", keeping.file, what));
    };
    if (keeping.bands == 0) {
        if (keeping.begun && bands.size() > 1)
            refuse("the checkpoint is of a picture in one piece, which does not fit the memory "
                   "here: give it more --film-memory");
        if (bands.size() > 1)
            listener.info(fmt::format("the film does not fit the memory: rendering {} bands, one "
                                      "after the other",
                                      bands.size()));
        return bands;
    }
    const Crop all = area.rendered();
    if (keeping.bands > all.height)
        refuse(fmt::format("the checkpoints are of {} bands, and the picture has {} rows: give the "
                           "same -r and --crop",
                           keeping.bands, all.height));
    // A row is rendered whether it fits or not.
    if (keeping.bands < bands.size() && bands.size() < all.height)
        refuse(fmt::format("the checkpoints are of {} bands, which do not fit the memory here: "
                           "give them more --film-memory",
                           keeping.bands));
    listener.info(fmt::format("rendering {} bands, one after the other, as before", keeping.bands));
    return inBands(area, keeping.bands);
}

Keeping keepingOfBand(const Keeping& keeping, size_t band, size_t count) {
    Keeping result = keeping;
    if (count == 1 || keeping.file.empty()) {
        result.bands = 0;
        return result;
    }
    result.file = bandFile(keeping.file, band, count).string();
    result.begun.reset();
    result.keepsAtEnd = true; // until all are done
    if (keeping.bands > 0 && fs::exists(result.file)) result.begun = readCheckpoint(result.file);
    return result;
}

void forgetEarlier(const std::string& file, size_t bands) {
    removeBandFiles(file);
    std::error_code failed; // what cannot be removed does no harm
    if (bands > 1) fs::remove(file, failed);
}

KeptRender keptRender(const RenderSettings& settings, const Keeping& keeping,
                      std::function<RenderIdentity()> identity, const std::string& device,
                      const Listener& listener) {
    KeptRender render;
    render.identity = std::move(identity);
    render.settings = settings;
    render.file = keeping.file;
    render.everySeconds = keeping.everySeconds;
    render.keepsAtEnd = keeping.keepsAtEnd;
    if (!keeping.begun) return render;

    const std::string name = keeping.file.empty() ? "the saved render" : keeping.file;
    requireSameRender(name, *keeping.begun, render.identity(), settings);
    if (keeping.begun->identity.device != device)
        listener.warn(fmt::format("{} was begun on {}: pictures agree, their bytes need not", name,
                                  keeping.begun->identity.device));
    render.begun = withBudget(keeping.begun->state, settings.budget);
    listener.info(fmt::format("goes on from {}, which has {:.1f} samples a pixel", name,
                              meanSamples(*render.begun)));
    return render;
}

} // namespace stromboli
