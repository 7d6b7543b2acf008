#include "host/cli/bench_options.hpp"

#include "host/cli/declare_options.hpp"
#include "host/core/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

namespace stromboli {
namespace {

constexpr uint32_t kMostRepeats = 1000, kMostRaysPerPixel = 1024;
/// What scene/generate makes.
constexpr uint64_t kFewestTriangles = 1000, kMostTriangles = 100'000'000;

std::vector<std::string> partNames() {
    std::vector<std::string> names;
    for (const bench::Part part : bench::kAllParts)
        names.push_back(bench::nameOf(part));
    return names;
}

/// "4M", "10k" or "50000".
uint64_t parseSize(const std::string& text) {
    uint64_t size = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, size);
    const std::string suffix(end, last);
    const uint64_t unit = suffix == "k" ? 1000 : suffix == "M" ? 1'000'000 : 1;
    const bool known = suffix.empty() || unit > 1;
    if (error != std::errc() || !known || size > kMostTriangles || size * unit < kFewestTriangles ||
        size * unit > kMostTriangles)
        throw UsageError(
            fmt::format("--sizes: '{}' is no number of triangles from 1k to 100M", text));
    return size * unit;
}

std::vector<uint64_t> parseSizes(const std::string& list) {
    std::vector<uint64_t> sizes;
    if (list.empty()) return sizes;
    std::istringstream in(list + ","); // so that nothing after the last comma is an item too
    for (std::string item; std::getline(in, item, ',');)
        sizes.push_back(parseSize(item));
    return sizes;
}

void checkRange(const char* what, uint32_t value, uint32_t most) {
    if (value < 1 || value > most)
        throw UsageError(fmt::format("{} is {}: expected 1 to {}", what, value, most));
}

} // namespace

void declareBench(CLI::App& app, RawBenchOptions& raw, BenchOptions& options) {
    app.add_option("SCENE", raw.scenes,
                   "files, scenes of scene/library by name, or generate:cornell_mesh:N "
                   "[cornell_boxes cornell_mesh generate:cornell_mesh:1000000]")
        ->group("Scenes");
    app.add_option("--sizes", raw.sizes,
                   "also: time per ray in the generated mesh of so many triangles each, as "
                   "1k,10k,100k,1M,4M")
        ->type_name("N,N,...")
        ->group("Scenes");
    app.add_flag("--quick", raw.quick, "a short run: small pictures, few repeats, no large scene")
        ->group("Measuring");
    app.add_option("--repeats", raw.repeats, "rounds; each measures every contestant once [5]")
        ->type_name("N")
        ->group("Measuring");
    app.add_option("--rays", raw.raysPerPixel, "camera rays a pixel in ray sets [CPU: 1, GPU: 16]")
        ->type_name("N")
        ->group("Measuring");
    app.add_option("--only", raw.parts,
                   "bvh, rays, paths, variants, robustness, startup, transfer [all]")
        ->check(CLI::IsMember(partNames()))
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("PART,PART,...")
        ->group("Measuring");
    app.add_option("--json", options.jsonFile, "write all measurements as JSON")
        ->type_name("FILE.json")
        ->group("Output");
    app.add_flag("--probe-startup", raw.probeStartup)->group("");
}

void applyBenchDefaults(RawOptions& raw) {
    const uint32_t side = raw.bench.quick ? 192 : 512; // pixels
    if (raw.size.empty()) raw.size = {side, side};
    if (!raw.samples) raw.samples = raw.bench.quick ? 4 : 8;
    if (!raw.maxBounces) raw.maxBounces = 5;
}

void applyBench(const RawBenchOptions& raw, Options& o) {
    bench::BenchSettings& s = o.bench.settings;
    if (raw.quick) {
        s.scenes = {"cornell_boxes", "cornell_mesh"};
        s.repeats = 3;
        s.leastSeconds = 0.05;
    }
    if (!raw.scenes.empty()) s.scenes = raw.scenes;
    if (!raw.parts.empty()) {
        s.parts.clear();
        for (const bench::Part part : bench::kAllParts)
            if (std::count(raw.parts.begin(), raw.parts.end(), bench::nameOf(part)) > 0)
                s.parts.insert(part);
    }
    s.sizes = parseSizes(raw.sizes);
    s.repeats = raw.repeats.value_or(s.repeats);
    checkRange("--repeats", s.repeats, kMostRepeats);
    if (raw.raysPerPixel) checkRange("--rays", *raw.raysPerPixel, kMostRaysPerPixel);
    s.raysPerPixel = raw.raysPerPixel.value_or(0);
    s.width = o.settings.width;
    s.height = o.settings.height;
    s.samplesPerPixel = o.settings.samplesPerPixel;
    s.maxBounces = o.settings.maxBounces;
    s.seed = o.settings.seed;
    s.sampler = o.settings.sampler;
    s.threads = o.threads;
    s.device = o.device;
    o.bench.probeStartup = raw.probeStartup;
}

} // namespace stromboli
