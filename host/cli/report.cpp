#include "host/cli/report.hpp"

#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/json.hpp"
#include "host/core/log.hpp"
#include "host/film/image_file.hpp"
#include "host/version/version.hpp"
#include "scene/model/emitters.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace stromboli {

std::string percent(double share) {
    const double p = 100 * share;
    return fmt::format("{:.{}f}", p, p >= 10 ? 0 : p >= 1 ? 1 : p >= 0.1 ? 2 : 3);
}

std::string inWords(const PictureNoise& noise) {
    switch (noise.unknown) {
    case PictureNoise::Unknown::No:
        return fmt::format("noise about {} % (95 % range: {} to {} %)", percent(noise.estimate),
                           percent(noise.least), percent(noise.most));
    case PictureNoise::Unknown::TooFewSamples:
        return "noise unknown: it takes two samples a pixel to tell";
    case PictureNoise::Unknown::Black:
        return "noise unknown: no sample has met light";
    case PictureNoise::Unknown::TooFewPixels:
        return "noise unknown: nearly all of it is that of one or two pixels";
    }
    return {};
}

namespace {

void logNoise(const RenderResult& r, const StopRule& stop) {
    const std::string reached = inWords(r.noise);
    if (stop.noise == 0)
        logging::info(reached);
    else if (r.noise.known() && r.noise.most <= stop.noise)
        logging::info(fmt::format("{}; at most {} % was asked for", reached, percent(stop.noise)));
    else
        logging::warn(fmt::format("{}; at most {} % was asked for, but {} ended the render",
                                  reached, percent(stop.noise),
                                  r.cancelled ? "the interruption" : "--time or -s"));
}

} // namespace

void logReport(const RenderReport& report, const RenderSettings& settings) {
    const RenderResult& r = report.render;
    const double rate = double(r.counters.rays) * 1e-6 / std::max(r.renderSeconds, 1e-9);
    logging::info(fmt::format("{}: {} ({} to load, {} to build the BVH, {} to "
                              "prepare, {} to write)",
                              r.backend, formatDuration(r.renderSeconds),
                              formatDuration(report.loadSeconds), formatDuration(r.buildSeconds),
                              formatDuration(r.prepareSeconds),
                              formatDuration(report.writeSeconds)));
    const std::string share = // of a number that nobody chose it says nothing
        settings.budget.spreads() || r.samplesAtMost == 0
            ? ""
            : fmt::format(" ({:.1f} % of the most)",
                          100.0 * double(r.samplesTaken) / double(r.samplesAtMost));
    logging::info(fmt::format("{} paths, {} rays, {:.2f} Mrays/s; {} samples{}, {} rejected",
                              r.counters.paths * settings.estimator.branches, r.counters.rays, rate,
                              r.samplesTaken, share, r.samplesRejected));
    if (r.pixelsUnreached > 0)
        logging::warn(fmt::format("{} of {} pixels have no sample ({}); they show a neighbour that "
                                  "has, or black",
                                  r.pixelsUnreached, settings.area.pixelCount(),
                                  r.cancelled ? "interrupted" : "--time is too short for more"));
    if (settings.estimator.integrator == Integrator::Path && !report.isShare)
        logNoise(r, settings.budget.stop);
    if (!r.firstRejected) return;
    logging::warn(fmt::format(
        "{} samples were not finite, negative or too large and were left out; to see the "
        "first, add --pixel {} {} --sample {} to the command",
        r.samplesRejected, r.firstRejected->x, r.firstRejected->y, r.firstRejected->sample));
}

void logBrightness(const Brightness& b, const Scene& scene, const std::string& file) {
    if (b.unlit) {
        const size_t lights = scene.lights.size() + collectEmitters(scene).size();
        logging::warn(fmt::format(
            "the picture is black: no path met light ({}); the camera may be inside an object or "
            "look past the scene (--camera frame), or the light may be cut off (-m)",
            lights == 0 ? "the scene has none"
                        : fmt::format("lights and emitting surfaces: {}", lights)));
        return;
    }
    if (!isPng(file)) return; // it keeps all radiances
    if (b.darkShare == 1)
        logging::warn(fmt::format("the picture is so dark that all of it is black in 8 bits: "
                                  "--exposure {:.0f}, or write an .exr file",
                                  *b.exposure));
    else if (b.whiteShare > 0.5)
        logging::warn(fmt::format("{:.0f} % of the pixels are brighter than white: --exposure "
                                  "{:.1f}, or write an .exr file",
                                  100 * b.whiteShare, *b.exposure));
}

void writeStatistics(const std::string& file, const RenderReport& report, const Scene& scene,
                     const RenderSettings& s) {
    const RenderResult& r = report.render;
    Json json = {
        {"version", version()},
        {"scene", scene.file},
        {"backend", r.backend},
        {"complete", r.complete()},
        {"pixels", s.area.pixelCount()},
        {"pixelsWithoutSamples", r.pixelsUnreached},
        {"width", s.area.width},
        {"height", s.area.height},
        {"samplesPerPixel",
         s.estimator.branches * (s.budget.meanSamplesPerPixel > 0 ? s.budget.meanSamplesPerPixel
                                                                  : s.budget.mostSamplesPerPixel)},
        {"branches", s.estimator.branches},
        {"spread", s.budget.spreads() || s.budget.adaptive.enabled ? "by noise" : "even"},
        {"maxBounces", s.estimator.maxBounces},
        {"seed", s.estimator.seed},
        {"sampler", nameOf(s.estimator.sampler)},
        {"triangles", scene.triangles.size()},
        {"spheres", scene.spheres.size()},
        {"seconds",
         {{"load", report.loadSeconds},
          {"build", r.buildSeconds},
          {"prepare", r.prepareSeconds},
          {"render", r.renderSeconds}}},
        {"paths", r.counters.paths * s.estimator.branches},
        {"rays", r.counters.rays},
        {"raysPerSecond", double(r.counters.rays) / std::max(r.renderSeconds, 1e-9)},
        {"samplesTaken", r.samplesTaken},
        {"samplesAtMost", r.samplesAtMost},
        {"samplesRejected", r.samplesRejected},
        {"noise", r.noise.known() ? Json(r.noise.estimate) : Json()},
        {"noiseRange", r.noise.known() ? Json(std::array{r.noise.least, r.noise.most}) : Json()},
    };
    if (report.isShare)
        json["seconds"]["write"] = report.writeSeconds; // of pictures it is still to come
    writeOutput(file, json.dump(4) + "\n");
}

} // namespace stromboli
