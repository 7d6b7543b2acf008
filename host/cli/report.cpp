#include "host/cli/report.hpp"

#include "host/cli/progress.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/core/log.hpp"
#include "host/render/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace stromboli {

RenderReport summarise(const Film& film, const RenderSettings& settings) {
    RenderReport r;
    const std::vector<uint32_t> pixels = cropPixels(settings.area);
    for (uint32_t pixel : pixels) {
        r.samplesTaken += uint64_t(film.pixels[pixel].taken()) * film.branches;
        r.samplesRejected += film.pixels[pixel].rejected;
    }
    r.samplesAtMost = samplesAtMost(settings.area, settings.budget) * settings.estimator.branches;
    return r;
}

namespace {

void logNoise(const RenderReport& r, const StopRule& stop) {
    const std::string reached = fmt::format("noise about {:.2f} %", 100 * r.noise);
    if (stop.noise == 0)
        logging::info(reached);
    else if (r.noise <= stop.noise)
        logging::info(fmt::format("{}, asked for {:.2f} %", reached, 100 * stop.noise));
    else
        logging::warn(fmt::format("{}, more than the {:.2f} % asked for: {} ended the render",
                                  reached, 100 * stop.noise,
                                  r.complete ? "--time or -s" : "the interruption"));
}

} // namespace

void logReport(const RenderReport& r, const Film& film, const RenderSettings& settings) {
    const double rate = double(r.counters.rays) * 1e-6 / std::max(r.renderSeconds, 1e-9);
    logging::info(fmt::format("{}: {} ({} to load, {} to build the BVH)", r.backend,
                              formatDuration(r.renderSeconds), formatDuration(r.loadSeconds),
                              formatDuration(r.buildSeconds)));
    const std::string share = // of a number that nobody chose it says nothing
        settings.budget.spreads() || r.samplesAtMost == 0
            ? ""
            : fmt::format(" ({:.1f} % of the most)",
                          100.0 * double(r.samplesTaken) / double(r.samplesAtMost));
    logging::info(fmt::format("{} paths, {} rays, {:.2f} Mrays/s; {} samples{}, {} rejected",
                              r.counters.paths * film.branches, r.counters.rays, rate,
                              r.samplesTaken, share, r.samplesRejected));
    if (settings.estimator.integrator == Integrator::Path) logNoise(r, settings.budget.stop);
    if (r.samplesRejected == 0) return;
    const auto first = std::find_if(film.pixels.begin(), film.pixels.end(),
                                    [](const PixelStatistics& p) { return p.rejected > 0; });
    const auto index = uint32_t(first - film.pixels.begin());
    logging::warn(fmt::format(
        "{} samples were not finite, negative or too large and were left out; to see the "
        "first, add --pixel {} {} --sample {} to the command",
        r.samplesRejected, index % film.width, index / film.width, first->firstRejected));
}

void writeStatistics(const std::string& file, const RenderReport& r, const Job& job) {
    const RenderSettings& s = job.settings;
    const Json json = {
        {"scene", job.scene.file},
        {"backend", r.backend},
        {"complete", r.complete},
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
        {"triangles", job.scene.triangles.size()},
        {"spheres", job.scene.spheres.size()},
        {"seconds",
         {{"load", r.loadSeconds}, {"build", r.buildSeconds}, {"render", r.renderSeconds}}},
        {"paths", r.counters.paths * s.estimator.branches},
        {"rays", r.counters.rays},
        {"raysPerSecond", double(r.counters.rays) / std::max(r.renderSeconds, 1e-9)},
        {"samplesTaken", r.samplesTaken},
        {"samplesAtMost", r.samplesAtMost},
        {"samplesRejected", r.samplesRejected},
        {"noise", r.noise},
    };
    const std::string text = json.dump(4) + "\n";
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace stromboli
