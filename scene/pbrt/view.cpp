#include "scene/pbrt/view.hpp"

#include "scene/build/number_word.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/build/vectors.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <string_view>

namespace stromboli::pbrt {
namespace {

/// Other ways to the picture of a path tracer of the same depth.
constexpr std::array<std::string_view, 11> kPaths = {
    "path",      "volpath",       "bdpt",       "mlt",       "sppm",       "simplepath",
    "lightpath", "simplevolpath", "pathguided", "photonmap", "exphotonmap"};

} // namespace

void View::readFilm(const std::string& kind, const Parameters& film) {
    if (kind != "image" && kind != "rgb" && kind != "gbuffer" && kind != "spectral")
        film.replace(build::Shortfall::Model, "is no film that is read", "a film of colours");
    constexpr double kMost = 65536;
    width_ = uint32_t(film.number("xresolution", 1280, 1, kMost));
    height_ = uint32_t(film.number("yresolution", 720, 1, kMost));
    diagonal_ = film.number("diagonal", 35, 1e-3, 1e6);
    readCrop(film);
    readSensor(film);
    film.skip({"filename", "savefp16", "coordinatesystem", "nbuckets", "lambdamin", "lambdamax",
               "displayfilename"});
    for (const char* limit : {"maxcomponentvalue", "maxsampleluminance"})
        if (film.has(limit)) {
            film.skip({limit});
            context_.report().ignore(fmt::format("'{}' of the film", limit),
                                     "samples are not clamped here");
        }
    film.reportUnread();
}

void View::readCrop(const Parameters& film) {
    std::vector<double> window = film.numbers("cropwindow");
    std::vector<double> pixels = film.numbers("pixelbounds");
    RenderHints& hints = context_.builder.hints();
    hints.crop.reset();
    const std::array<double, 2> sides = {double(width_), double(height_)};
    if (window.size() == 4) { // shares of the picture
        for (size_t i = 0; i < 4; ++i)
            window[i] = std::ceil(std::clamp(window[i], 0.0, 1.0) * sides[i / 2]);
    } else if (pixels.size() == 4) {
        window = pixels;
    } else {
        if (!window.empty() || !pixels.empty())
            film.replaceParameter(window.empty() ? "pixelbounds" : "cropwindow",
                                  build::Shortfall::Word, "has not four numbers");
        return;
    }
    std::array<uint32_t, 4> edges{};
    for (size_t i = 0; i < 4; ++i)
        edges[i] =
            uint32_t(std::clamp(std::isfinite(window[i]) ? window[i] : 0.0, 0.0, sides[i / 2]));
    const auto [left, right] = std::minmax(edges[0], edges[1]);
    const auto [top, bottom] = std::minmax(edges[2], edges[3]);
    if (left == right || top == bottom)
        return film.replaceParameter("cropwindow", build::Shortfall::Word, "is empty");
    if (right - left == width_ && bottom - top == height_) return;
    hints.crop = std::array{left, top, right - left, bottom - top};
}

/// What the film's numbers are for a radiance of 1.
void View::readSensor(const Parameters& film) {
    iso_ = film.number("iso", 100, 0, 1e9);
    filmScale_ = film.number("scale", 1, 0, 1e30);
    if (const std::optional<double> time = film.number("exposuretime")) exposureTime_ = time;
    const std::string sensor = film.text("sensor").value_or("cie1931");
    if (sensor != "cie1931")
        film.replace(build::Shortfall::Model, fmt::format("has the sensor '{}'", sensor),
                     "the sensor cie1931");
    if (const double kelvins = film.number("whitebalance").value_or(0); kelvins != 0)
        context_.report().ignore(
            "'whitebalance' of the film",
            fmt::format("colours stay as they are (--white-balance {:.0f} makes such light white)",
                        kelvins));
}

void View::readFilter(const std::string& kind, const Parameters& filter) {
    RenderHints& hints = context_.builder.hints();
    HintedFilterShape& shape = hints.filterShape;
    hasFilter_ = true;
    const auto radius = [&](double otherwise) {
        // pbrt-v3 calls it xwidth, which is the same.
        const char* other = filter.has("xwidth") ? "xwidth" : "xradius";
        const double value = filter.number(other, otherwise, 1e-3, 1e3);
        filter.skip({"xradius", "yradius", "xwidth", "ywidth"});
        return value;
    };
    if (kind == "box") {
        hints.filter = HintedFilter::Box;
        if (radius(0.5) != 0.5) { // as wide in the mean
            filter.replace(build::Shortfall::Model, "is a box wider or narrower than a pixel",
                           "a box of one pixel");
        }
    } else if (kind == "triangle") {
        hints.filter = HintedFilter::Tent;
        shape.radius = radius(2);
    } else if (kind == "gaussian") {
        hints.filter = HintedFilter::Gaussian;
        radius(context_.isV3() ? 2 : 1.5);
        shape.deviation = context_.isV3() ? std::sqrt(0.5 / filter.number("alpha", 2, 1e-3, 1e6))
                                          : filter.number("sigma", 0.5, 1e-3, 1e3);
    } else if (kind == "mitchell") {
        hints.filter = HintedFilter::Mitchell;
        radius(2);
        shape.b = filter.number("B", 1.0 / 3, -10, 10);
        shape.c = filter.number("C", 1.0 / 3, -10, 10);
    } else if (kind == "sinc" || kind == "lanczos") {
        hints.filter = HintedFilter::Lanczos;
        radius(4);
        shape.lobes = uint32_t(std::lround(filter.number("tau", 3, 1, 64)));
    } else {
        filter.replace(build::Shortfall::Model, "is no filter that is read", "the default filter");
        hasFilter_ = false;
    }
    filter.reportUnread();
}

void View::readIntegrator(const std::string& kind, const Parameters& integrator) {
    RenderHints& hints = context_.builder.hints();
    constexpr double kMost = 10000;
    hints.maxBounces = uint32_t(integrator.number("maxdepth", 5, 0, kMost));
    const bool isPath = std::ranges::find(kPaths, kind) != kPaths.end();
    if (!isPath)
        integrator.replace(build::Shortfall::Model, "is no integrator that is read",
                           "path, of the same depth");
    else if (kind != "path" && kind != "volpath")
        context_.report().assume(
            fmt::format("integrator '{}': path takes its place, of the same depth", kind));
    // They say how samples are taken, and not of what.
    integrator.skip({"rrthreshold",
                     "lightsamplestrategy",
                     "lightsampler",
                     "regularize",
                     "pixelbounds",
                     "visualizestrategies",
                     "visualizeweights",
                     "bootstrapsamples",
                     "chains",
                     "mutationsperpixel",
                     "largestepprobability",
                     "sigma",
                     "iterations",
                     "numiterations",
                     "photonsperiteration",
                     "imagewritefrequency",
                     "radius",
                     "seed",
                     "samplebsdf",
                     "samplelights",
                     "strategy",
                     "cossample",
                     "nsamples",
                     "maxdistance"});
    integrator.reportUnread();
}

void View::setCamera(const std::string& kind, Parameters camera, const glm::dmat4& cameraFromWorld,
                     uint32_t medium) {
    camera_ = CameraRead{kind, std::move(camera), cameraFromWorld, medium};
}

/// The extent of the picture on the plane at distance 1, half of its shorter side.
double View::halfShorterSide(const CameraRead& camera) const {
    const Parameters& p = camera.parameters;
    if (camera.kind == "perspective") {
        const std::optional<double> half = p.number("halffov");
        double degrees = half ? 2 * *half : p.number("fov").value_or(90);
        if (!(degrees > 0 && degrees < 180)) {
            p.replaceParameter(
                "fov", build::Shortfall::Word,
                fmt::format("is {}, expected more than 0 and less than 180", degrees));
            degrees = 90;
        }
        return std::tan(glm::radians(degrees) / 2);
    }
    // A lens of 50 mm before the film.
    return halfShorterSideOfFilm() / 0.05;
}

double View::halfShorterSideOfFilm() const {
    constexpr double kMillimetre = 1e-3;
    const double aspect = double(std::max(width_, height_)) / std::min(width_, height_);
    return diagonal_ * kMillimetre / 2 / std::sqrt(1 + aspect * aspect);
}

/// The focal length that the name of a lens file states, as pbrt's own do: "wide.22mm.dat"; metres.
static std::optional<double> focalLengthIn(const std::string& name) {
    std::smatch found;
    if (!std::regex_search(name, found, std::regex("([0-9]{1,4}(\\.[0-9]{1,4})?) ?mm")))
        return std::nullopt;
    const std::optional<double> length = build::realIn(found[1].str());
    if (!length || !(*length > 0)) return std::nullopt;
    return *length * 1e-3;
}

/// What is seen through the lens of several elements of a realistic camera; nothing if there is
/// nothing to say what it is.
std::optional<ThinLens> View::lensOf(const CameraRead& read) const {
    const Parameters& p = read.parameters;
    const std::optional<std::string> file = p.text("lensfile");
    if (read.kind != "realistic" || !file) return std::nullopt;
    const double aperture = p.number("aperturediameter", 1, 1e-6, 1e6) * 1e-3;
    const double focus = p.number("focusdistance", 10, 1e-6, 1e9);
    std::optional<ThinLens> lens;
    build::tolerate(context_.report(), build::Shortfall::Model, [&] {
        lens = thinLensOf(surfacesOf(context_, p, aperture), focus);
        if (!lens) p.placeOf(*p.find("lensfile")).fail("names a lens that makes no picture");
    });
    if (!lens)
        if (const std::optional<double> length = focalLengthIn(*file))
            lens = thinLensOf(simpleLens(*length, aperture), focus);
    return lens;
}

/// pbrt has such cameras in metres, the film at their origin.
void View::setLens(const CameraRead& read, const ThinLens& lens, FileCamera& camera,
                   glm::dmat4& pose) {
    const Parameters& p = read.parameters;
    p.replace(build::Shortfall::Model, "has a lens of several elements",
              fmt::format("a thin lens of {:.1f} mm", 1e3 * lens.focalLength));
    if (p.has("aperture"))
        p.replaceParameter("aperture", build::Shortfall::Parameter,
                           "is the shape of the stop, which is round here");
    const glm::dvec3 scale = build::axisLengths(pose);
    pose = pose * glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, lens.beforeFilm));
    constexpr double kFar = 1e6;
    camera.lensRadius = lens.radius * scale.x;
    camera.focusDistance = (lens.focusDistance > 0 ? lens.focusDistance : kFar) * scale.z;
    // pbrt-v3 leaves the lens's share of the light out unless it is told not to.
    const bool isWeighted = !context_.isV3() || !p.flag("simpleweighting", true);
    lensLight_ = isWeighted ? lens.irradiance : 1;
}

void View::placeCamera(const CameraRead& read) {
    const Parameters& p = read.parameters;
    FileCamera camera;
    camera.name = read.kind;
    camera.medium = read.medium;
    const bool isOrthographic = read.kind == "orthographic";
    const std::optional<ThinLens> lens = lensOf(read);
    if (!lens && !isOrthographic && read.kind != "perspective")
        p.replace(build::Shortfall::Model, "is no camera that is read",
                  "a perspective one with a lens of 50 mm");
    double aspect = double(width_) / height_;
    aspect = p.number("frameaspectratio", aspect, 1e-3, 1e3);
    // The window on the plane at distance 1 in units of half the shorter side.
    std::array<double, 4> window = {-std::max(aspect, 1.0), std::max(aspect, 1.0),
                                    -std::max(1 / aspect, 1.0), std::max(1 / aspect, 1.0)};
    const std::vector<double> stated = p.numbers("screenwindow");
    if (stated.size() == 4 && stated[0] < stated[1] && stated[2] < stated[3])
        std::ranges::copy(stated, window.begin());
    else if (!stated.empty())
        p.replaceParameter("screenwindow", build::Shortfall::Word,
                           "is no window, expected left, right, bottom and top");
    const double unit = isOrthographic ? 1
                        : lens         ? halfShorterSideOfFilm() * lens->perFilmLength
                                       : halfShorterSide(read);
    camera.halfWidth = unit * (window[1] - window[0]) / 2;
    camera.halfHeight = unit * (window[3] - window[2]) / 2;
    const glm::dvec2 middle = unit * glm::dvec2(window[0] + window[1], window[2] + window[3]) / 2.0;
    camera.projection = isOrthographic ? Projection::Orthographic : Projection::Perspective;
    glm::dmat4 pose = glm::inverse(read.cameraFromWorld);
    if (isOrthographic)
        pose = pose * glm::translate(glm::dmat4(1.0), glm::dvec3(middle, 0));
    else
        camera.shift = middle;
    const double radius = p.number("lensradius", 0, 0, 1e30);
    const double focus = p.number("focaldistance", 1e6, 1e-12, 1e30);
    if (isOrthographic && radius > 0) {
        context_.report().ignore("'lensradius' of an orthographic camera",
                                 "such cameras have no lens here");
    } else if (lens) {
        setLens(read, *lens, camera, pose);
    } else {
        // Lengths of the camera's own space.
        const glm::dvec3 scale = build::axisLengths(pose);
        camera.lensRadius = radius * scale.x;
        camera.focusDistance = radius > 0 ? focus * scale.z : 1;
    }
    p.skip({"shutteropen", "shutterclose", "lensfile", "aperturediameter", "focusdistance",
            "simpleweighting", "mapping", "aperture", "fov", "halffov"});
    p.reportUnread();
    // pbrt's camera looks along z, x to the right.
    pose = pose * glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1));
    context_.builder.placeCamera(std::move(camera), pose, glm::determinant(glm::dmat3(pose)) < 0);
}

void View::finish() {
    RenderHints& hints = context_.builder.hints();
    hints.width = width_;
    hints.height = height_;
    if (!hints.maxBounces) hints.maxBounces = 5;
    if (!hasFilter_) hints.filter = context_.isV3() ? HintedFilter::Box : HintedFilter::Gaussian;
    double shutter = 1;
    if (camera_) {
        const Parameters& p = camera_->parameters;
        shutter = p.number("shutterclose").value_or(1) - p.number("shutteropen").value_or(0);
        placeCamera(*camera_);
    }
    const double time = std::max(exposureTime_.value_or(shutter), 0.0);
    context_.imagingRatio =
        lensLight_ * (context_.isV3() ? filmScale_ : filmScale_ * time * iso_ / 100);
    if (!(context_.imagingRatio > 0)) {
        context_.report().warn("the film sees no light: its exposure or its scale is 0; 1 is "
                               "taken");
        context_.imagingRatio = 1;
    }
}

} // namespace stromboli::pbrt
