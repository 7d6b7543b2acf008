#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kRepeats{1, 1000}, kRaysPerPixel{1, 1024}, kSide{1, 65536},
    kBounces{0, 10000}, kSamples{1, kMostSamples}, kSeeds{0, 0xFFFFFFFFu};
/// What scene/generate makes.
constexpr uint64_t kFewestTriangles = 1000, kMostTriangles = 100'000'000;

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

bench::Part partNamed(const std::string& name) {
    if (const auto part = valueNamed<bench::Part>(name)) return *part;
    throw UsageError(fmt::format("--only is '{}': expected {}", name, allNames<bench::Part>()));
}

/// A short run.
void beQuick(bench::BenchSettings& s) {
    s.scenes = {"cornell_boxes", "cornell_mesh"};
    s.repeats = 3;
    s.leastSeconds = 0.05;
    s.width = s.height = 192;
    s.samplesPerPixel = 4;
}

void declareMeasuring(OptionList& list, bench::BenchSettings& s) {
    list.group("Measuring");
    list.flag("--quick", "a short run: small pictures, few repeats, no large scene",
              [&s] { beQuick(s); })
        .changesDefaults();
    list.number("--repeats", "N", "rounds; each measures every contestant once", s.repeats,
                kRepeats);
    list.number("--rays", "N", "camera rays a pixel in ray sets", s.raysPerPixel, kRaysPerPixel)
        .usually("CPU: 1, GPU: 16");
    list.words("--only", "PART,PART,...", "what to measure (" + allMeanings<bench::Part>() + ")", 1,
               [&s](const Words& words) {
                   s.parts.clear();
                   for (const std::string& word : words)
                       s.parts.insert(partNamed(word));
               })
        .usually("all")
        .separatedByCommas = true;
    list.numbers("-r,--size", "W H", "picture size", {&s.width, &s.height}, kSide)
        .usually(fmt::format("{} {}; --quick: 192 192", s.width, s.height));
    list.number("-m,--max-bounces", "N", "scatterings of light at most", s.maxBounces, kBounces);
    list.group("Sampling");
    list.number("-s,--samples", "N", "samples per pixel in a measurement of paths",
                s.samplesPerPixel, kSamples)
        .usually(fmt::format("{}; --quick: 4", s.samplesPerPixel));
    list.choice("--sampler", "WHICH", "where random numbers come from", s.sampler);
    list.number("--seed", "N", "another seed, another noise", s.seed, kSeeds);
}

} // namespace

void declareBench(DeclaredCommand& c) {
    BenchOptions& o = c.options.bench;
    bench::BenchSettings& s = o.settings;
    OptionList& list = c.list;
    list.group("Scenes");
    list.list("SCENE", "", "files, scenes of scene/library by name, or generate:cornell_mesh:N",
              s.scenes)
        .usually(fmt::format("{}", fmt::join(s.scenes, " ")));
    list.words("--sizes", "N,N,...",
               "also: time per ray in the generated mesh of so many triangles each, as "
               "1k,10k,100k,1M,4M",
               1, [&s](const Words& words) { s.sizes = parseSizes(words[0]); });
    declareMeasuring(list, s);
    list.group("Output");
    list.text("--json", "FILE.json", "write all measurements as JSON", o.jsonFile);
    list.flag("--probe-startup", "time the stages of this process's start, and no more",
              o.probeStartup)
        .hidden();
    declareDevice(c);
    declareHost(c);
    c.finish = [&c, &s] {
        s.threads = c.options.threads;
        s.device = c.options.device;
    };
}

} // namespace stromboli
