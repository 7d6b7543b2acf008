// Settings of pictures, devices and scenes by their names. The ranges and what is taken where
// nothing is said are those of the command line (host/cli/*_options.cpp).
#include "host/api/named_settings.hpp"

#include "host/api/setting_values.hpp"
#include "host/core/error.hpp"
#include "host/core/text.hpp"
#include "host/render/sampling_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace stromboli::api {
namespace {

// --- Tables --------------------------------------------------------------------------------------

template <class Target>
struct Row {
    const char* name;
    const char* meaning;
    void (*set)(Target&, std::string_view, const Value&);
};

template <class Target>
void setByTable(std::span<const Row<Target>> rows, const char* what, Target& target,
                std::string_view name, const Value& value) {
    for (const Row<Target>& row : rows)
        if (row.name == name) return row.set(target, name, value);
    std::vector<std::string_view> all;
    for (const Row<Target>& row : rows)
        all.emplace_back(row.name);
    throw UsageError(
        fmt::format("there is no {} '{}': expected one of {}", what, name, fmt::join(all, ", ")));
}

template <class Target>
std::vector<NamedThing> namesOf(std::span<const Row<Target>> rows) {
    std::vector<NamedThing> result;
    for (const Row<Target>& row : rows)
        result.push_back({row.name, row.meaning});
    return result;
}

using Name = std::string_view;

constexpr Row<CameraRequest> kCameraRows[] = {
    {"camera", "auto, file, frame, or the name or number (from 1) of a camera of the scene",
     [](CameraRequest& c, Name n, const Value& v) {
         if (std::holds_alternative<std::vector<double>>(v)) {
             c = {CameraChoice::File, std::to_string(whole(n, v, 1, 1u << 30))};
             return;
         }
         const std::string& text = std::get<std::string>(v);
         if (text == "auto" || text == "file" || text == "frame")
             c.choice = text == "auto"   ? CameraChoice::Automatic
                        : text == "file" ? CameraChoice::File
                                         : CameraChoice::Frame;
         else
             c.choice = CameraChoice::File, c.name = text;
     }},
    {"look_from", "the point (x, y, z), metres, from which to look",
     [](CameraRequest& c, Name n, const Value& v) { c.from = point(n, v); }},
    {"look_at", "the point (x, y, z) that look_from looks at; else the scene's middle",
     [](CameraRequest& c, Name n, const Value& v) { c.at = point(n, v); }},
    {"fov", "angle of view over the height of the picture, degrees",
     [](CameraRequest& c, Name n, const Value& v) {
         c.fieldOfView = number(n, v, 1e-6, 179.999) * glm::pi<double>() / 180;
     }},
    {"aperture", "diameter of a thin lens, metres; 0: a pinhole",
     [](CameraRequest& c, Name n, const Value& v) { c.aperture = number(n, v, 0, kFarthest); }},
    {"focus", "what is sharp: metres along the axis, auto (the middle), or a pixel's (column, row)",
     [](CameraRequest& c, Name n, const Value& v) { c.focus = focus(n, v); }},
    {"turn", "degrees by which the camera is turned about the scene's middle, seen from above",
     [](CameraRequest& c, Name n, const Value& v) {
         c.turn = number(n, v, -1e6, 1e6) * glm::pi<double>() / 180;
     }},
};

using Asked = PictureSettings::Asked;

constexpr Row<Asked> kPictureRows[] = {
    {"samples", "samples per pixel, on the mean; with noise or time the most",
     [](Asked& a, Name n, const Value& v) { a.samples = whole(n, v, 1, kMostSamples); }},
    {"even", "whether all pixels get the same number of samples",
     [](Asked& a, Name n, const Value& v) { a.even = yes(n, v); }},
    {"noise", "go on until the noise, the root of the relMSE, is at most this in 95 of 100 renders",
     [](Asked& a, Name n, const Value& v) {
         a.request.budget.stop.noise = number(n, v, 1e-6, 1e6);
     }},
    {"time", "take samples for at most so many seconds",
     [](Asked& a, Name n, const Value& v) {
         a.request.budget.stop.seconds = number(n, v, 0.01, 1e9);
     }},
    {"seed", "another seed, another noise",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.seed = whole(n, v, 0, 0xFFFFFFFFu);
     }},
    {"width", "of the picture, pixels; with height",
     [](Asked& a, Name n, const Value& v) { a.width = whole(n, v, 1, 65536); }},
    {"height", "of the picture, pixels; with width",
     [](Asked& a, Name n, const Value& v) { a.height = whole(n, v, 1, 65536); }},
    {"crop", "only this part: left, top, width, height in pixels",
     [](Asked& a, Name n, const Value& v) {
         const auto c = numbers(n, v, 4, 0, 65536, "left, top, width and height in pixels");
         a.request.crop = {uint32_t(c[0]), uint32_t(c[1]), uint32_t(c[2]), uint32_t(c[3])};
         if (a.request.crop.width == 0 || a.request.crop.height == 0)
             refuse(n, v, "a width and a height of at least 1");
     }},
    {"background", "where no surface is: radiance (one or three numbers), or a picture's file",
     [](Asked& a, Name n, const Value& v) {
         const auto* file = std::get_if<std::string>(&v);
         a.request.background =
             file ? backgroundFrom(*file)
                  : Background{1, 1, {color(n, v, 1e30, "one or three radiances from 0 on")}};
     }},
    {"transparent", "alpha in place of the environment",
     [](Asked& a, Name n, const Value& v) { a.request.transparent = yes(n, v); }},
    {"shadow_catcher",
     "ground, or another object or material of the scene, of which only shadows are in the picture",
     [](Asked& a, Name n, const Value& v) { a.request.shadowCatcher = word(n, v, "a name"); }},
    {"layers",
     "albedo, normal, depth, transmittance, position, uv, object, material, with commas between",
     [](Asked& a, Name n, const Value& v) { a.request.layers = layers(n, v); }},
    {"denoise", "off, on or oidn",
     [](Asked& a, Name n, const Value& v) { a.request.denoiser = choice<Denoiser>(n, v); }},
    {"keep_noisy", "a denoised picture has the noisy one and the predicted error as layers too",
     [](Asked& a, Name n, const Value& v) { a.request.keepsNoisy = yes(n, v); }},
    {"max_bounces", "scatterings of light at most",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.maxBounces = whole(n, v, 0, 10000);
         a.hasBounces = true;
     }},
    {"min_bounce", "light scattered fewer times is left out",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.minBounce = whole(n, v, 0, 10000);
         a.hasBounces = true;
     }},
    {"clamp_indirect",
     "light that was scattered twice or more brings at most this at a time: biased",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.indirectLimit = number(n, v, 1e-6, 1e30);
     }},
    {"light_samples", "samples of lights per shading point",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.lightSamples = whole(n, v, 1, 1024);
     }},
    {"direct", "how lights are found: mis, mis-all, lights, hemisphere or bsdf",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.directLight = choice<DirectLight>(n, v);
     }},
    {"light_choice", "which light a sample takes: auto, tree, power, uniform or each",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.lightChoice = choice<LightChoice>(n, v);
     }},
    {"roulette", "none, throughput or a probability of ending a path at every hit",
     [](Asked& a, Name n, const Value& v) { a.request.estimator.roulette = roulette(n, v); }},
    {"gap_proposal", "whether some bounces go into the gap behind a light, or into shades of lamps",
     [](Asked& a, Name n, const Value& v) { a.request.estimator.gapProposal = yes(n, v); }},
    {"branches", "paths that share a camera ray; samples is a multiple of it",
     [](Asked& a, Name n, const Value& v) { a.request.branches = whole(n, v, 1, 64); }},
    {"guiding", "which pictures' light samples are guided: auto, on or off",
     [](Asked& a, Name n, const Value& v) { a.request.guiding = choice<Guiding>(n, v); }},
    {"portals", "whether light samples to the sky aim at openings: auto, on or off",
     [](Asked& a, Name n, const Value& v) { a.request.portals = choice<PortalUse>(n, v); }},
    {"integrator", "path, normals or depth",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.integrator = choice<Integrator>(n, v);
         a.hasIntegrator = true;
     }},
    {"sampler", "where random numbers come from: sobol or independent",
     [](Asked& a, Name n, const Value& v) { a.request.estimator.sampler = choice<Sampler>(n, v); }},
    {"filter", "box, gaussian, blackman-harris, tent, mitchell, catmull-rom or lanczos",
     [](Asked& a, Name n, const Value& v) {
         a.request.estimator.filter = choice<PixelFilter>(n, v);
         a.hasFilter = true;
     }},
};

constexpr Row<DeviceRequest> kDeviceRows[] = {
    {"backend", "vulkan or reference",
     [](DeviceRequest& d, Name n, const Value& v) { d.backend = choice<BackendChoice>(n, v); }},
    {"device", "number, UUID or part of a name from `stromboli devices`, or cpu; or several",
     [](DeviceRequest& d, Name n, const Value& v) { d.device = word(n, v, "a device's name"); }},
    {"scheduler", "persistent or wavefront",
     [](DeviceRequest& d, Name n, const Value& v) { d.scheduler = choice<PathScheduler>(n, v); }},
    {"threads", "of the reference; 0: all",
     [](DeviceRequest& d, Name n, const Value& v) { d.threads = whole(n, v, 0, 65536); }},
    {"film_memory", "mebibytes for the film; a picture that needs more is rendered in bands",
     [](DeviceRequest& d, Name n, const Value& v) { d.filmMebibytes = whole(n, v, 1, 1u << 30); }},
};

constexpr Row<SceneRequest> kReadingRows[] = {
    {"environment",
     "light from all around: a picture's file or the name of a bundled one, or "
     "radiance (one or three numbers)",
     [](SceneRequest& s, Name n, const Value& v) {
         if (const auto* file = std::get_if<std::string>(&v)) {
             s.environment.file = *file;
             return;
         }
         s.environment.constant = color(n, v, 1e30, "one or three radiances from 0 on");
     }},
    {"sun", "a clear sky: degrees clockwise from -z and above the horizon, and maybe haze, 1 to 10",
     [](SceneRequest& s, Name n, const Value& v) { s.environment.sun = sun(n, v); }},
    {"ground", "a floor under all there is, of this colour: one or three numbers",
     [](SceneRequest& s, Name n, const Value& v) {
         s.ground = {true, color(n, v, 1, "one or three shares in [0, 1]")};
     }},
    {"portal", "objects, with commas between, that are openings to the sky in place of surfaces",
     [](SceneRequest& s, Name n, const Value& v) { s.portals = names(n, v, "names of objects"); }},
    {"environment_rotation", "degrees about the vertical",
     [](SceneRequest& s, Name n, const Value& v) {
         s.environment.rotationDegrees = number(n, v, -3600, 3600);
     }},
    {"environment_strength", "multiplies its radiance",
     [](SceneRequest& s, Name n, const Value& v) {
         s.environment.strength = number(n, v, 0, 1e9);
     }},
    {"fog", "extinction of fog that fills the scene, per metre",
     [](SceneRequest& s, Name n, const Value& v) { s.fog.density = number(n, v, 0, 1e9); }},
    {"fog_color", "the share of its light that is scattered: one or three numbers",
     [](SceneRequest& s, Name n, const Value& v) {
         s.fog.color = color(n, v, 1, "one or three shares in [0, 1]");
     }},
    {"fog_asymmetry", "mean cosine of its phase function, from -0.9999 to 0.9999",
     [](SceneRequest& s, Name n, const Value& v) {
         s.fog.asymmetry = number(n, v, -double(kMostAsymmetry), double(kMostAsymmetry));
     }},
    {"default_light", "whether a plain sky lights a scene without any light",
     [](SceneRequest& s, Name n, const Value& v) { s.reading.defaultLight = yes(n, v); }},
    {"up", "y or z: which axis points up in files that do not say so",
     [](SceneRequest& s, Name n, const Value& v) { s.reading.up = choice<UpAxis>(n, v); }},
    {"strict", "whether what breaks the rules of the format is an error",
     [](SceneRequest& s, Name n, const Value& v) { s.reading.strict = yes(n, v); }},
    {"scene", "glTF: the scene of this number, from 0",
     [](SceneRequest& s, Name n, const Value& v) {
         s.reading.selection.scene = whole(n, v, 0, 0xFFFFFFFEu);
     }},
    {"variant", "glTF: the set of materials of this name",
     [](SceneRequest& s, Name n, const Value& v) {
         s.reading.selection.variant = word(n, v, "a name");
     }},
    {"at", "glTF: seconds of the first animation",
     [](SceneRequest& s, Name n, const Value& v) {
         s.reading.selection.seconds = number(n, v, 0, 1e9);
     }},
    {"max_texture", "pictures are halved until no side has more pixels; 0: never",
     [](SceneRequest& s, Name n, const Value& v) {
         s.reading.selection.largestTexture = whole(n, v, 0, 65536);
     }},
    {"instances", "auto, on or off: whether meshes shown several times share their triangles",
     [](SceneRequest& s, Name n, const Value& v) {
         s.reading.instances = choice<InstanceSharing>(n, v);
     }},
};

// --- Meaning -------------------------------------------------------------------------------------

/// As the command line spreads samples: where they help most, unless something else is asked for.
void finishBudget(RenderRequest& request, const Asked& asked) {
    PathBudget& budget = request.budget;
    const bool isOpen = budget.stop.open();
    if (isOpen && asked.even)
        throw UsageError("even: noise and time say where samples go, too: give one of them");
    if (asked.samples)
        budget.mostPathsPerPixel = *asked.samples;
    else if (isOpen)
        budget.mostPathsPerPixel.reset();
    if (asked.even) budget.pathsPerBlock = 128;
    if (request.branches && (asked.samples || !isOpen) &&
        budget.pathsPerPixel() % *request.branches != 0)
        throw UsageError(fmt::format("samples: {} is not a multiple of branches: {}",
                                     budget.pathsPerPixel(), *request.branches));
    if (asked.even || isOpen || budget.pathsPerPixel() <= NoisePlan::kFirstPaths) return;
    budget.meanPathsPerPixel = budget.pathsPerPixel();
    budget.mostPathsPerPixel.reset();
}

} // namespace

void PictureSettings::set(std::string_view name, const Value& value) {
    for (const auto& row : kCameraRows)
        if (row.name == name) return row.set(asked_.request.camera, name, value);
    setByTable<Asked>(kPictureRows, "setting", asked_, name, value);
}

RenderRequest PictureSettings::request() const {
    RenderRequest request = asked_.request;
    const Estimator& estimator = request.estimator;
    if (asked_.width.has_value() != asked_.height.has_value())
        throw UsageError("width and height belong together: one of them is missing");
    if (asked_.width) request.size = {*asked_.width, *asked_.height};
    if (estimator.minBounce > estimator.maxBounces)
        throw UsageError(fmt::format("min_bounce: {} is more than max_bounces: {}",
                                     estimator.minBounce, estimator.maxBounces));
    if (request.camera.at && !request.camera.from)
        throw UsageError("look_at needs look_from, which says from where");
    request.leftToFile = {.bounces = !asked_.hasBounces,
                          .filter = !asked_.hasFilter,
                          .integrator = !asked_.hasIntegrator};
    finishBudget(request, asked_);
    return request;
}

std::vector<NamedThing> PictureSettings::names() {
    std::vector<NamedThing> all = namesOf<Asked>(kPictureRows);
    for (NamedThing& row : namesOf<CameraRequest>(kCameraRows))
        all.push_back(std::move(row));
    return all;
}

void setCamera(CameraRequest& camera, std::string_view name, const Value& value) {
    setByTable<CameraRequest>(kCameraRows, "setting of a camera", camera, name, value);
}

void setDevice(DeviceRequest& device, std::string_view name, const Value& value) {
    setByTable<DeviceRequest>(kDeviceRows, "setting of a device", device, name, value);
}

std::vector<NamedThing> deviceNames() {
    return namesOf<DeviceRequest>(kDeviceRows);
}

void setReading(SceneRequest& scene, std::string_view name, const Value& value) {
    setByTable<SceneRequest>(kReadingRows, "setting of loading", scene, name, value);
}

std::vector<NamedThing> readingNames() {
    return namesOf<SceneRequest>(kReadingRows);
}

} // namespace stromboli::api
