#include "host/engine/render_request.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "host/film/image_file.hpp"
#include "host/render/sampling_session.hpp"
#include "host/render/settings.hpp"
#include "scene/model/default_light.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// Which view was taken, where the file leaves a choice or is not followed.
void reportCamera(const Scene& scene, const Camera& camera, const RenderRequest& request,
                  const Listener& listener) {
    if (request.camera.from) {
        if (!scene.bounds().empty() && !mayShow(camera, scene))
            listener.warn("from --look-from nothing of the scene is in the picture");
        return;
    }
    const std::optional<size_t> chosen = chosenCamera(scene, request.camera, request.framing);
    if (!chosen) {
        listener.info(fmt::format("{} has no camera: framing the whole scene", scene.file));
        return;
    }
    const std::string name = fmt::format("camera '{}'", scene.cameras[*chosen].name);
    const bool isChoice = request.camera.choice == CameraChoice::Automatic;
    const bool framed = isFramed(scene, request.camera, request.framing);
    if (framed && isChoice)
        listener.info(fmt::format(
            "framing the whole scene instead of taking the file's {} (--camera file)", name));
    const bool isNamed = !request.camera.name.empty() || request.camera.place;
    if (!framed && scene.cameras.size() > 1 && !isNamed)
        listener.info(fmt::format("{}, the {} of {} (--camera NAME for another; info lists them)",
                                  name, request.framing.lastOfSeveral ? "last" : "first",
                                  scene.cameras.size()));
    if (!framed && !scene.bounds().empty() && !mayShow(camera, scene))
        listener.warn(fmt::format("{} sees nothing of the scene: all of it is out of its field of "
                                  "view or of its depth range (--camera frame shows it)",
                                  name));
}

/// How far away what is sharp is, where the scene decides it.
void reportFocus(const Camera& camera, const RenderRequest& request, const Listener& listener) {
    const std::optional<Focus>& focus = request.camera.focus;
    const bool isFound = focus ? focus->on != Focus::On::Distance : request.camera.aperture > 0;
    if (isFound)
        listener.info(fmt::format("the lens is sharp at {:.4g} m (--focus)", camera.focusDistance));
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
Estimator withHints(const RenderHints& hints, const RenderRequest& request) {
    Estimator estimator = request.estimator;
    const LeftToFile& left = request.leftToFile;
    if (hints.maxBounces && left.bounces) estimator.maxBounces = *hints.maxBounces;
    if (hints.filter && left.filter) useFilter(hints, estimator);
    if (hints.rouletteStart) estimator.roulette.throughputStart = *hints.rouletteStart;
    if (hints.showsDepth && left.integrator) estimator.integrator = Integrator::Depth;
    if (hints.hidesBackdrop || request.transparent || request.background)
        estimator.showsBackdrop = false;
    return estimator;
}

void reportHints(const RenderHints& hints, const RenderSettings& settings,
                 const RenderRequest& request, const Listener& listener) {
    const LeftToFile& left = request.leftToFile;
    std::string taken;
    const auto add = [&](const std::string& what) { taken += (taken.empty() ? "" : ", ") + what; };
    if (hints.showsDepth && left.integrator) add("--integrator depth");
    if (hints.maxBounces && left.bounces) add(fmt::format("-m {}", settings.estimator.maxBounces));
    const Roulette& roulette = settings.estimator.roulette;
    if (hints.rouletteStart && roulette.mode == Roulette::Mode::Throughput)
        add(fmt::format("roulette from bounce {} on", roulette.throughputStart));
    if (hints.filter && left.filter)
        add(fmt::format("--filter {}{}", nameOf(settings.estimator.filter),
                        shapeText(settings.estimator)));
    if (hints.width && !request.size)
        add(fmt::format("-r {} {}", settings.area.width, settings.area.height));
    if (const Crop& crop = settings.area.crop;
        hints.crop && request.crop.width == 0 && crop.width != 0)
        add(fmt::format("--crop {} {} {} {}", crop.x, crop.y, crop.width, crop.height));
    if (!taken.empty()) listener.info(fmt::format("the scene file asks for {}", taken));
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

/// The size and the crop that are asked for, by the user or else by the scene's file.
PictureArea areaOf(const Scene& scene, const RenderRequest& request) {
    const PictureSize size =
        request.size.value_or(defaultPictureSize(scene, request.camera, request.framing));
    PictureArea area{size.width, size.height, request.crop};
    const RenderHints& hints = scene.hints;
    if (!request.size && hints.crop && hints.width == size.width && request.crop.width == 0)
        area.crop = {(*hints.crop)[0], (*hints.crop)[1], (*hints.crop)[2], (*hints.crop)[3]};
    return area;
}

} // namespace

std::vector<std::string> RenderRequest::channels() const {
    std::vector<std::string> names;
    if (transparent) names.emplace_back(kAlphaChannel);
    for (const Layer layer : layers)
        for (std::string& name : channelsOf(layer))
            names.push_back(std::move(name));
    if (denoiser != Denoiser::Off && keepsNoisy)
        names.insert(names.end(), denoise::channelNames().begin(), denoise::channelNames().end());
    return names;
}

namespace {

/// With fewer samples it takes longer to learn than is gained.
constexpr uint32_t kLeastGuidedPaths = 16;
bool guidesLight(const RenderRequest& request) {
    if (request.guiding != Guiding::Automatic) return request.guiding == Guiding::On;
    return request.budget.pathsPerPixel() >= kLeastGuidedPaths;
}

} // namespace

ResolvedPicture resolvePicture(const Scene& scene, const RenderRequest& request,
                               const Listener& listener) {
    if (request.transparent && request.background)
        throw UsageError("a picture that is transparent has no background");
    if (request.background)
        for (const std::string& fault : request.background->faults)
            listener.warn(fault);
    ResolvedPicture picture;
    RenderSettings& settings = picture.settings;
    settings = {areaOf(scene, request), withHints(scene.hints, request), {}};
    const uint32_t branches =
        request.branches.value_or(branchesThatPay(scene, settings.estimator, request.budget));
    settings.estimator.branches = branches;
    settings.estimator.guidesLight = guidesLight(request);
    settings.estimator.aimsAtPortals =
        request.portals == PortalUse::On ||
        (request.portals == PortalUse::Automatic && request.guiding != Guiding::On);
    settings.budget = inSamples(request.budget, branches);
    checkCrop(settings.area);
    checkPictureFits(settings.area, 3 + request.channels().size());
    picture.camera = request.resolvedCamera ? *request.resolvedCamera
                                            : makeCamera(scene, request.camera, settings.area.width,
                                                         settings.area.height, request.framing);
    reportHints(scene.hints, settings, request, listener);
    reportFocus(picture.camera, request, listener);
    reportCamera(scene, picture.camera, request, listener);
    return picture;
}

void warnOfBlackPicture(const Scene& scene, const std::string& name, const RenderRequest& request,
                        const Listener& listener) {
    const bool isOfLight = request.estimator.integrator == Integrator::Path;
    if (scene.placedTriangles() == 0 && scene.spheres.empty())
        listener.warn(fmt::format("{} has no surfaces: the picture is {}", name,
                                  request.transparent                      ? "all transparent"
                                  : isOfLight && hasSomethingToDraw(scene) ? "of what is around it"
                                                                           : "black"));
    else if (!shines(scene) && isOfLight)
        listener.warn(fmt::format("{} has no light: the picture is black (--default-light on: a "
                                  "plain sky lights it)",
                                  name));
}

uint64_t mostPathsOf(const RenderSettings& settings) {
    return samplesAtMost(settings.area, settings.budget) * settings.estimator.branches;
}

} // namespace stromboli
