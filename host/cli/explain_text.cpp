// What `render --pixel` prints.
#include "host/cli/explain_text.hpp"

#include "host/core/color.hpp"
#include "host/core/printable.hpp"
#include "shaders/shared/bsdf_types.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stromboli {
namespace {

constexpr size_t kHeaviest = 8;

std::string threeOf(const glm::dvec3& v) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z);
}

/// What is no number is a word, since JSON has none for it.
Json jsonOf(double x) {
    if (std::isnan(x)) return "nan";
    if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
    return x;
}
Json jsonOf(const glm::dvec3& v) {
    return Json::array({jsonOf(v.x), jsonOf(v.y), jsonOf(v.z)});
}

std::string objectOf(const Scene& scene, uint32_t primitive, uint32_t placement) {
    if (primitive == kNotNamed) return "";
    const size_t triangles = scene.triangles.size();
    const uint32_t number = placement != kNotNamed ? scene.placements.at(placement).instance
                            : primitive < triangles
                                ? scene.triangles[primitive].instance
                                : scene.spheres.at(primitive - triangles).instance;
    return number < scene.instances.size() ? scene.instances[number] : "";
}

std::string materialOf(const Scene& scene, uint32_t primitive) {
    if (primitive == kNotNamed) return "";
    const size_t triangles = scene.triangles.size();
    return scene.materials
        .at(primitive < triangles ? scene.triangles[primitive].material
                                  : scene.spheres.at(primitive - triangles).material)
        .name;
}

std::string lobeName(uint32_t lobe) {
#define NAME_LOBE(name, bit, label)                                                                \
    if (lobe == gpu::name) return label;
    CLOSURE_LIST(NAME_LOBE)
#undef NAME_LOBE
    return "none";
}

const char* fateName(RecordedLight::Fate fate) {
    switch (fate) {
    case RecordedLight::Fate::BringsNothing:
        return "brings nothing";
    case RecordedLight::Fate::InShadow:
        return "in shadow";
    case RecordedLight::Fate::Arrives:
        return "arrives";
    }
    return "";
}

/// "x", or "x | y" with what the reference says.
std::string sideBySide(const std::string& own, const std::string& other) {
    return other.empty() ? own : own + " | " + other;
}

/// The number of a density, where there is one.
std::string densityOf(double pdf) {
    return pdf > 0 ? fmt::format("{:.6g}", pdf) : "-";
}

std::string placeOf(const Scene& scene, const RecordedVertex& v) {
    if (v.met == RecordedVertex::Met::Nothing) return "nothing";
    const std::string at =
        fmt::format(" at {}, {:.6g} m on", threeOf(v.position + scene.origin), v.distance);
    if (v.met == RecordedVertex::Met::Medium) return "a medium" + at;
    return fmt::format("{} of {}{}", printable(objectOf(scene, v.primitive, v.placement)),
                       printable(materialOf(scene, v.primitive)), at);
}

bool isSamePlace(const RecordedVertex& a, const RecordedVertex& b) {
    return a.met == b.met && a.primitive == b.primitive && a.placement == b.placement;
}

std::string textOfLight(const Scene& scene, const RecordedLight& l, const RecordedLight* other) {
    const std::string object = objectOf(scene, l.primitive, kNotNamed);
    std::string text = "    light sample: " + (l.kind.empty() ? "light" : l.kind);
    if (!object.empty()) text += " " + printable(object);
    text += fmt::format(", pdf {}, MIS weight {:.4g}, ", densityOf(l.pdf), l.weight);
    text +=
        sideBySide(fateName(l.fate), other && other->fate != l.fate ? fateName(other->fate) : "");
    if (l.fate == RecordedLight::Fate::Arrives ||
        (other && other->fate == RecordedLight::Fate::Arrives))
        text += ": " + sideBySide(threeOf(l.light), other ? threeOf(other->light) : "");
    return text + "\n";
}

std::string textOfBounce(const RecordedBounce& b, const RecordedBounce* other) {
    std::string text = fmt::format("    bounce: {}, pdf {}, to {}\n", lobeName(b.lobe),
                                   sideBySide(densityOf(b.pdf), other ? densityOf(other->pdf) : ""),
                                   threeOf(b.direction));
    constexpr double kNarrow = 1e5; // 1e-3 of it is what rounding does to a float's direction
    if (other && b.pdf > kNarrow)
        text += "    a lobe so narrow that the rounding of its direction shows\n";
    if (b.goesOn < 1)
        text += fmt::format("    roulette: goes on with {:.4g}: {}\n", b.goesOn,
                            b.survives ? "it does" : "it ends");
    else if (!b.survives)
        text += "    nothing is left: the path ends\n";
    return text;
}

std::string textOfVertex(const Scene& scene, size_t number, const RecordedVertex& v,
                         const RecordedVertex* other) {
    std::string text = fmt::format("{} ", number);
    if (v.returns)
        text += fmt::format("branch {} from {}\n", v.branch, placeOf(scene, v));
    else
        text += placeOf(scene, v) + "\n";
    if (other && !isSamePlace(v, *other))
        text += "    the reference meets " + placeOf(scene, *other) + "\n";
    if (!v.returns)
        text += "    throughput " +
                sideBySide(threeOf(v.throughput), other ? threeOf(other->throughput) : "") + "\n";
    if (v.aimedWeight != 1)
        text +=
            v.aimedWeight > 0
                ? fmt::format("    the bounce could aim here, and weighs {:.4g}\n", v.aimedWeight)
                : "    the bounce was aimed at another place: it brings nothing\n";
    const bool shines = v.light != glm::dvec3(0.0) || (other && other->light != glm::dvec3(0.0));
    if (shines)
        text += fmt::format("    {}, MIS weight {:.4g}: {}\n",
                            v.met == RecordedVertex::Met::Nothing ? "sky" : "shines", v.weight,
                            sideBySide(threeOf(v.light), other ? threeOf(other->light) : ""));
    if (v.goesOn < 1) text += fmt::format("    roulette: goes on with {:.4g}\n", v.goesOn);
    for (size_t i = 0; i < v.lights.size(); ++i)
        text += textOfLight(scene, v.lights[i],
                            other && i < other->lights.size() ? &other->lights[i] : nullptr);
    if (v.bounce)
        text += textOfBounce(*v.bounce, other && other->bounce ? &*other->bounce : nullptr);
    return text;
}

Json jsonOfLight(const Scene& scene, const RecordedLight& l) {
    return {{"kind", l.kind},
            {"object", printable(objectOf(scene, l.primitive, kNotNamed))},
            {"direction", jsonOf(l.direction)},
            {"distance", jsonOf(l.distance)},
            {"pdf", jsonOf(l.pdf)},
            {"mis_weight", jsonOf(l.weight)},
            {"fate", fateName(l.fate)},
            {"radiance", jsonOf(l.light)}};
}

Json jsonOfVertex(const Scene& scene, const RecordedVertex& v) {
    using Met = RecordedVertex::Met;
    Json json = {{"meets", v.met == Met::Nothing  ? "nothing"
                           : v.met == Met::Medium ? "medium"
                                                  : "surface"},
                 {"branch", v.branch},
                 {"returns", v.returns}};
    if (v.met != Met::Nothing) {
        json["object"] = printable(objectOf(scene, v.primitive, v.placement));
        json["material"] = printable(materialOf(scene, v.primitive));
        json["position"] = jsonOf(v.position + scene.origin);
        json["distance"] = jsonOf(v.distance);
    }
    json["direction"] = jsonOf(v.direction);
    json["throughput"] = jsonOf(v.throughput);
    json["mis_weight"] = jsonOf(v.weight);
    json["radiance"] = jsonOf(v.light);
    json["roulette"] = jsonOf(v.goesOn);
    json["lights"] = Json::array();
    for (const RecordedLight& l : v.lights)
        json["lights"].push_back(jsonOfLight(scene, l));
    if (v.bounce)
        json["bounce"] = {
            {"lobe", lobeName(v.bounce->lobe)},     {"direction", jsonOf(v.bounce->direction)},
            {"pdf", jsonOf(v.bounce->pdf)},         {"throughput", jsonOf(v.bounce->throughput)},
            {"roulette", jsonOf(v.bounce->goesOn)}, {"survives", v.bounce->survives}};
    return json;
}

} // namespace

// --- A sample ------------------------------------------------------------------------------------

std::string verdictOn(const glm::dvec3& radiance, bool rejected) {
    if (!rejected) return "accepted";
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(radiance[c])) return "rejected: not finite";
    const double least = std::min({radiance.x, radiance.y, radiance.z});
    return least < 0 ? "rejected: negative" : "rejected: too large";
}

std::string textOfPath(const std::vector<PathByBackend>& all, const Scene& scene) {
    const PathByBackend& taken = all.front();
    const RecordedPath& path = taken.path;
    const RecordedPath* other = all.size() > 1 ? &all[1].path : nullptr;
    const int digits = taken.isFloat ? 9 : 17;
    std::string text = fmt::format("radiance {:.{}g} {:.{}g} {:.{}g}\n{}\n", path.radiance.x,
                                   digits, path.radiance.y, digits, path.radiance.z, digits,
                                   verdictOn(path.radiance, path.rejected));
    if (path.vertices.empty()) return text;
    if (other)
        text += fmt::format("the same path by the reference: {}\nbelow: kernel | reference\n",
                            threeOf(other->radiance));
    text += fmt::format("0 camera at {} to {}\n", threeOf(path.origin + scene.origin),
                        threeOf(path.direction));
    for (size_t i = 0; i < path.vertices.size(); ++i)
        text += textOfVertex(scene, i + 1, path.vertices[i],
                             other && i < other->vertices.size() ? &other->vertices[i] : nullptr);
    if (path.branches > 1) text += fmt::format("what branches bring counts 1/{}\n", path.branches);
    if (!path.isWhole) text += "further vertices are not recorded\n";
    return text;
}

Json jsonOfPath(const std::vector<PathByBackend>& all, const Scene& scene) {
    Json json = Json::object();
    for (const PathByBackend& one : all) {
        Json own = {{"radiance", jsonOf(one.path.radiance)},
                    {"verdict", verdictOn(one.path.radiance, one.path.rejected)},
                    {"camera", jsonOf(one.path.origin + scene.origin)},
                    {"direction", jsonOf(one.path.direction)},
                    {"filter_weight", jsonOf(one.path.filterWeight)},
                    {"whole", one.path.isWhole}};
        own["vertices"] = Json::array();
        for (const RecordedVertex& v : one.path.vertices)
            own["vertices"].push_back(jsonOfVertex(scene, v));
        json[one.name] = std::move(own);
    }
    return json;
}

// --- A pixel -------------------------------------------------------------------------------------

std::vector<uint32_t> heaviestSamples(const std::vector<SampleValue>& samples, size_t most) {
    std::vector<uint32_t> numbers(samples.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    std::erase_if(numbers, [&](uint32_t n) { return samples[n].rejected; });
    std::ranges::stable_sort(numbers, std::greater<>(),
                             [&](uint32_t n) { return luminance(samples[n].radiance); });
    numbers.resize(std::min(numbers.size(), most));
    return numbers;
}

std::optional<double> deviationOf(const PixelStatistics& a, const PixelStatistics& b) {
    if (a.count < 2 || b.count < 2) return std::nullopt;
    const glm::dvec3 variance = a.varianceOfMean() + b.varianceOfMean();
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
        const double difference = std::abs(a.mean[c] - b.mean[c]);
        // Equal samples, but for rounding.
        if (difference <= 1e-5 * std::abs(b.mean[c])) continue;
        largest = std::max(largest, difference / std::sqrt(variance[c]));
    }
    return largest;
}

std::string textOfPixel(const std::vector<PixelByBackend>& all) {
    std::string text;
    for (const PixelByBackend& one : all) {
        const PixelStatistics& s = one.statistics;
        text +=
            fmt::format("{}\n  mean {}\n  variance of a sample {}\n  standard error of the mean, "
                        "of independent samples {}\n",
                        one.name, threeOf(s.mean), threeOf(s.variance()),
                        threeOf(glm::sqrt(s.varianceOfMean())));
        if (s.rejected > 0) text += fmt::format("  rejected {}\n", s.rejected);
        const double sum = luminance(s.mean) * s.count;
        text += "  heaviest samples (number, radiance, share of the pixel)\n";
        for (const uint32_t n : heaviestSamples(one.samples, kHeaviest)) {
            const glm::dvec3& radiance = one.samples[n].radiance;
            text += fmt::format("    {:>6}  {}  {:.3g} %\n", n, threeOf(radiance),
                                sum > 0 ? 100 * luminance(radiance) / sum : 0);
        }
    }
    if (all.size() < 2) return text;
    const std::optional<double> deviation = deviationOf(all[0].statistics, all[1].statistics);
    if (deviation) text += fmt::format("the means differ by {:.2g} standard errors\n", *deviation);
    return text;
}

Json jsonOfPixel(const std::vector<PixelByBackend>& all) {
    Json json = Json::object();
    for (const PixelByBackend& one : all) {
        const PixelStatistics& s = one.statistics;
        Json own = {{"samples", s.count},
                    {"rejected", s.rejected},
                    {"mean", jsonOf(s.mean)},
                    {"variance", jsonOf(s.variance())},
                    {"variance_of_mean", jsonOf(s.varianceOfMean())}};
        own["heaviest"] = Json::array();
        for (const uint32_t n : heaviestSamples(one.samples, kHeaviest))
            own["heaviest"].push_back(
                {{"sample", n}, {"radiance", jsonOf(one.samples[n].radiance)}});
        json[one.name] = std::move(own);
    }
    if (all.size() > 1)
        if (const auto deviation = deviationOf(all[0].statistics, all[1].statistics))
            json["standard_errors_apart"] = jsonOf(*deviation);
    return json;
}

} // namespace stromboli
