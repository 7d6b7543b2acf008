#include "host/cli/job.hpp"

#include "host/cli/activity.hpp"
#include "host/cli/seen_channels.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/memory.hpp"
#include "host/core/stopwatch.hpp"
#include "host/film/film.hpp"
#include "host/render/branches.hpp"
#include "scene/add_environment.hpp"
#include "scene/model/default_light.hpp"
#include "scene/read_scene.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

namespace stromboli {
namespace {

Job readFile(const Options& options) {
    nowDoing("loading " + options.scene);
    Stopwatch watch;
    SceneConventions reading = options.reading;
    if (options.environment.isGiven()) reading.defaultLight = false;
    Job job{readScene(options.scene, reading), {}, {}, 0};
    job.loadSeconds = watch.seconds();
    return job;
}

void reportScene(const Scene& scene, const Options& options) {
    for (const std::string& line : scene.report.warnings)
        logging::warn(line);
    for (const std::string& line : scene.report.forgiven)
        logging::warn(line);
    for (const std::string& line : scene.report.ignored)
        logging::info(fmt::format("ignored: {}", line));
    for (const std::string& line : scene.report.assumed)
        logging::info(line);
    if (scene.triangles.empty() && scene.spheres.empty())
        logging::warn(fmt::format("{} has no geometry: the picture is {}", options.scene,
                                  options.transparent ? "all transparent" : "black"));
    else if (!shines(scene) && options.estimator.integrator == Integrator::Path)
        logging::warn(fmt::format("{} has no light: the picture is black (--default-light on: a "
                                  "plain sky lights it)",
                                  options.scene));
}

/// Which view was taken, where the file leaves a choice or is not followed.
void reportCamera(const Job& job, const Options& options) {
    const Scene& scene = job.scene;
    if (options.camera.from) {
        if (!scene.bounds().empty() && !mayShow(job.camera, scene))
            logging::warn("from --look-from nothing of the scene is in the picture");
        return;
    }
    const std::optional<size_t> chosen = chosenCamera(scene, options.camera, options.framing);
    if (!chosen) {
        logging::info(fmt::format("{} has no camera: framing the whole scene", options.scene));
        return;
    }
    const std::string name = fmt::format("camera '{}'", scene.cameras[*chosen].name);
    const bool isChoice = options.camera.choice == CameraChoice::Automatic;
    const bool framed = isFramed(scene, options.camera, options.framing);
    if (framed && isChoice)
        logging::info(fmt::format("framing the whole scene, as the CS184 renderer does, instead of "
                                  "taking the file's {} (--camera file)",
                                  name));
    const bool isNamed = !options.camera.name.empty() || options.camera.place;
    if (!framed && scene.cameras.size() > 1 && !isNamed)
        logging::info(fmt::format("{}, the {} of {} (--camera NAME for another; info lists them)",
                                  name, options.framing.lastOfSeveral ? "last" : "first",
                                  scene.cameras.size()));
    if (!framed && !scene.bounds().empty() && !mayShow(job.camera, scene))
        logging::warn(fmt::format("{} sees nothing of the scene: all of it is out of its field of "
                                  "view or of its depth range (--camera frame shows it)",
                                  name));
}

PixelFilter filterOf(HintedFilter hinted) {
    switch (hinted) {
    case HintedFilter::Box:
        return PixelFilter::Box;
    case HintedFilter::Gaussian:
        return PixelFilter::Gaussian;
    case HintedFilter::Tent:
        return PixelFilter::Tent;
    case HintedFilter::Mitchell:
        return PixelFilter::Mitchell;
    case HintedFilter::CatmullRom:
        return PixelFilter::CatmullRom;
    case HintedFilter::Lanczos:
        return PixelFilter::Lanczos;
    }
    return PixelFilter::Box;
}

void useFilter(const RenderHints& hints, Estimator& estimator) {
    const HintedFilterShape& shape = hints.filterShape;
    const HintedFilterShape usual;
    estimator.filter = filterOf(*hints.filter);
    estimator.filterShape.b = shape.b;
    estimator.filterShape.c = shape.c;
    estimator.filterShape.lobes = shape.lobes;
    if (*hints.filter == HintedFilter::Gaussian)
        estimator.filterShape.width = shape.deviation / usual.deviation;
    if (*hints.filter == HintedFilter::Tent)
        estimator.filterShape.width = shape.radius / usual.radius;
}

/// The numbers of the filter, where they are not the usual ones.
std::string shapeText(const Estimator& estimator) {
    const FilterShape& shape = estimator.filterShape;
    if (shape == FilterShape{}) return "";
    if (estimator.filter == PixelFilter::Mitchell)
        return fmt::format(" (B {:g}, C {:g})", shape.b, shape.c);
    if (estimator.filter == PixelFilter::Lanczos) return fmt::format(" ({} lobes)", shape.lobes);
    if (shape.width != 1) return fmt::format(" ({:g} times as wide)", shape.width);
    return "";
}

/// The estimator with what the scene file asks for and the user leaves open.
Estimator withHints(const RenderHints& hints, const Options& options) {
    Estimator estimator = options.estimator;
    if (hints.maxBounces && !options.bouncesGiven) estimator.maxBounces = *hints.maxBounces;
    if (hints.filter && !options.filterGiven) useFilter(hints, estimator);
    if (hints.rouletteStart) estimator.roulette.throughputStart = *hints.rouletteStart;
    if (hints.showsDepth && !options.integratorGiven) estimator.integrator = Integrator::Depth;
    if (hints.hidesBackdrop) estimator.showsBackdrop = false;
    return estimator;
}

void reportHints(const Job& job, const Options& options) {
    const RenderHints& hints = job.scene.hints;
    std::string taken;
    const auto add = [&](const std::string& what) { taken += (taken.empty() ? "" : ", ") + what; };
    if (hints.showsDepth && !options.integratorGiven) add("--integrator depth");
    if (hints.maxBounces && !options.bouncesGiven)
        add(fmt::format("-m {}", job.settings.estimator.maxBounces));
    const Roulette& roulette = job.settings.estimator.roulette;
    if (hints.rouletteStart && roulette.mode == Roulette::Mode::Throughput)
        add(fmt::format("roulette from bounce {} on", roulette.throughputStart));
    if (hints.filter && !options.filterGiven)
        add(fmt::format("--filter {}{}", nameOf(job.settings.estimator.filter),
                        shapeText(job.settings.estimator)));
    if (hints.width && !options.sizeGiven)
        add(fmt::format("-r {} {}", job.settings.area.width, job.settings.area.height));
    if (const Crop& crop = job.settings.area.crop;
        hints.crop && options.area.crop.width == 0 && crop.width != 0)
        add(fmt::format("--crop {} {} {} {}", crop.x, crop.y, crop.width, crop.height));
    if (!taken.empty()) logging::info(fmt::format("the scene file asks for {}", taken));
}

void checkCrop(const PictureArea& s) {
    if (s.crop.width == 0) return;
    if (uint64_t(s.crop.x) + s.crop.width > s.width ||
        uint64_t(s.crop.y) + s.crop.height > s.height)
        throw UsageError(fmt::format("--crop {} {} {} {} is not inside the picture of {} x {}",
                                     s.crop.x, s.crop.y, s.crop.width, s.crop.height, s.width,
                                     s.height));
}

/// Films may be made in bands; the picture that is written is in the host's memory as a whole,
/// twice: before and after it is compressed.
void checkPictureFits(const PictureArea& s, uint64_t channels) {
    const uint64_t bytes = 2 * s.pixelCount() * channels * sizeof(float);
    if (bytes > physicalMemory())
        throw UsageError(fmt::format("a picture of {} pixels takes {} MiB to write, more than this "
                                     "machine's memory: render it in parts (--crop)",
                                     s.pixelCount(), bytes >> 20));
}

} // namespace

std::future<vulkan::OpenDevice> openDeviceMeanwhile(const Options& options) {
    return std::async(std::launch::async, vulkan::openDevice, options.device);
}

Job loadJob(const Options& options) {
    Job job = readFile(options);
    Stopwatch watch;
    if (options.environment.isGiven()) {
        EnvironmentRequest environment = options.environment;
        environment.largestSide = options.reading.selection.largestTexture;
        environment.strict = options.reading.strict;
        addEnvironment(job.scene, environment);
    }
    job.loadSeconds += watch.seconds();
    reportScene(job.scene, options);
    return job;
}

Job loadMoment(const Options& options, Job& before) {
    Job job = readFile(options);
    if (options.environment.isGiven())
        addEnvironment(job.scene, std::move(*std::exchange(before.scene.environment, {})));
    return job;
}

void setPicture(Job& job, const Options& options) {
    job.settings = {options.area, withHints(job.scene.hints, options), {}};
    const Estimator& estimator = job.settings.estimator;
    if (!options.sizeGiven) {
        const PictureSize size = defaultPictureSize(job.scene, options.camera, options.framing);
        job.settings.area.width = size.width;
        job.settings.area.height = size.height;
        const RenderHints& hints = job.scene.hints;
        if (hints.crop && hints.width == size.width && options.area.crop.width == 0)
            job.settings.area.crop = {(*hints.crop)[0], (*hints.crop)[1], (*hints.crop)[2],
                                      (*hints.crop)[3]};
    }
    const uint32_t branches =
        options.branches.value_or(branchesThatPay(job.scene, estimator, options.budget));
    job.settings.estimator.branches = branches;
    job.settings.budget = inSamples(options.budget, branches);
    checkCrop(job.settings.area);
    checkPictureFits(job.settings.area, 3 + seenChannelNames(options).size());
    job.camera = makeCamera(job.scene, options.camera, job.settings.area.width,
                            job.settings.area.height, options.framing);
    reportHints(job, options);
    reportCamera(job, options);
}

Job prepareJob(const Options& options) {
    Job job = loadJob(options);
    setPicture(job, options);
    return job;
}

BuiltScene buildScene(const Job& job, KeptParts* kept, uint64_t gatheredRows) {
    nowDoing(fmt::format("building the BVH of {} triangles", job.scene.triangles.size()));
    Stopwatch watch;
    BuiltScene built;
    built.gpu = packScene(job.scene, buildWideBvh(job.scene, {}, kept ? &kept->trees : nullptr),
                          lightSelection(job.settings.estimator),
                          kept ? kept->environment : nullptr, gatheredRows);
    if (kept) kept->environment = built.gpu.lights.environment;
    built.buildSeconds = watch.seconds();
    nowDoing("opening the device and compiling the kernel"); // what follows a scene that is built
    return built;
}

} // namespace stromboli
