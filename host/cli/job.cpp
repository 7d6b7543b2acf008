#include "host/cli/job.hpp"

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/stopwatch.hpp"
#include "host/film/film.hpp"
#include "host/render/branches.hpp"
#include "scene/model/emitters.hpp"
#include "scene/read_scene.hpp"

#include <fmt/format.h>

#include <unistd.h>

namespace stromboli {
namespace {

void reportLoading(const Scene& scene, const Options& options) {
    for (const std::string& line : scene.report.warnings)
        logging::warn(line);
    for (const std::string& line : scene.report.ignored)
        logging::info(fmt::format("ignored: {}", line));
    if (scene.cameras.empty())
        logging::info(fmt::format("{} has no camera: framing the whole scene", options.scene));
    if (scene.triangles.empty() && scene.spheres.empty())
        logging::warn(fmt::format("{} has no geometry: the picture is black", options.scene));
    if (scene.lights.empty() && collectEmitters(scene).empty() &&
        options.estimator.integrator == Integrator::Path)
        logging::warn(fmt::format("{} has no light: the picture is black", options.scene));
}

void checkCrop(const PictureArea& s) {
    if (s.crop.width == 0) return;
    if (uint64_t(s.crop.x) + s.crop.width > s.width ||
        uint64_t(s.crop.y) + s.crop.height > s.height)
        throw UsageError(fmt::format("--crop {} {} {} {} is not inside the picture of {} x {}",
                                     s.crop.x, s.crop.y, s.crop.width, s.crop.height, s.width,
                                     s.height));
}

/// The film of the whole picture is kept in the host's memory, whatever the backend.
void checkFilmFits(const PictureArea& s) {
    const uint64_t bytes = uint64_t(s.width) * s.height * sizeof(PixelStatistics);
    const uint64_t memory = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE));
    if (bytes > memory / 2) // the other half is for the scene and the pictures made of the film
        throw UsageError(fmt::format("a picture of {} x {} needs {} MiB for its film, more than "
                                     "half of this machine's memory",
                                     s.width, s.height, bytes >> 20));
}

} // namespace

std::future<vulkan::OpenDevice> openDeviceMeanwhile(const Options& options) {
    return std::async(std::launch::async, vulkan::openDevice, options.device);
}

Job prepareJob(const Options& options) {
    Stopwatch watch;
    Job job{
        readScene(options.scene, options.reading), {}, {options.area, options.estimator, {}}, 0};
    job.loadSeconds = watch.seconds();
    reportLoading(job.scene, options);
    if (!options.sizeGiven) {
        const PictureSize size = defaultPictureSize(job.scene, options.camera, options.framing);
        job.settings.area.width = size.width;
        job.settings.area.height = size.height;
    }
    const uint32_t branches =
        options.branches.value_or(branchesThatPay(job.scene, options.estimator, options.budget));
    job.settings.estimator.branches = branches;
    job.settings.budget = inSamples(options.budget, branches);
    checkCrop(job.settings.area);
    checkFilmFits(job.settings.area);
    job.camera = makeCamera(job.scene, options.camera, job.settings.area.width,
                            job.settings.area.height, options.framing);
    return job;
}

BuiltScene buildScene(const Job& job) {
    Stopwatch watch;
    BuiltScene built;
    built.gpu =
        packScene(job.scene, buildWideBvh(job.scene), lightSelection(job.settings.estimator));
    built.buildSeconds = watch.seconds();
    return built;
}

} // namespace stromboli
