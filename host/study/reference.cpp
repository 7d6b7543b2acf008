#include "host/study/reference.hpp"

#include "host/compare/metrics.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/core/log.hpp"
#include "host/core/stopwatch.hpp"
#include "host/film/image_file.hpp"
#include "host/render/render.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <span>

namespace stromboli::study {
namespace {

namespace fs = std::filesystem;

/// What the picture was made of, in a file beside it.
Json labelOf(const SceneStudy& scene) {
    const Reference& r = scene.reference;
    return {{"scene", scene.name},
            {"content", scene.content},
            {"options", r.options},
            {"samples", r.samples},
            {"seconds", r.seconds}};
}

std::optional<compare::Picture> kept(const fs::path& picture, const fs::path& label,
                                     SceneStudy& scene) {
    Reference& described = scene.reference;
    std::ifstream file(label);
    const Json json = Json::parse(file, nullptr, false);
    if (!json.is_object() || json.value("options", std::string()) != described.options ||
        json.value("scene", std::string()) != scene.name ||
        json.value("content", std::string()) != scene.content ||
        json.value("samples", 0u) < described.samples || !fs::exists(picture))
        return std::nullopt;
    described.samples = json.value("samples", 0u);
    described.seconds = json.value("seconds", 0.0);
    compare::Picture read = compare::readPicture(picture);
    if (!read.film) return std::nullopt;
    return read;
}

/// The film, or none if it was stopped.
std::optional<Film> renderReference(const std::string& scene, const StudySettings& settings,
                                    const std::vector<std::string>& options, const Prepare& prepare,
                                    const KeepGoing& keepGoing) {
    std::vector<std::string> words = options;
    for (const std::string& word :
         {std::string("--even"), std::string("-s"), fmt::format("{}", settings.referenceSamples)})
        words.push_back(word);
    PreparedRender render = prepare(scene, words);
    bool stopped = false;
    Film film =
        stromboli::render(*render.backend, render.settings, [&](const RenderProgress& progress) {
            stopped = !keepGoing(double(progress.samplesDone) / double(progress.samplesAtMost));
            return !stopped;
        });
    if (stopped) return std::nullopt;
    return film;
}

} // namespace

std::optional<compare::Picture> referencePicture(const fs::path& folder, const std::string& name,
                                                 const StudySettings& settings,
                                                 const Prepare& prepare, const KeepGoing& keepGoing,
                                                 SceneStudy& scene) {
    Reference& described = scene.reference;
    const fs::path picture = folder / (name + ".exr"), label = folder / (name + ".json");
    std::vector<std::string> words = splitOptions(settings.commonOptions);
    for (const std::string& word : splitOptions(settings.referenceOptions))
        words.push_back(word);
    words.push_back("--seed");
    words.push_back(fmt::format("{}", kReferenceSeed));
    described.file = (folder.filename() / picture.filename()).string();
    described.samples = settings.referenceSamples;
    described.options = fmt::format("{}", fmt::join(words, " "));
    if (auto found = kept(picture, label, scene)) {
        describeError(*found, described);
        return found;
    }
    const Stopwatch watch;
    const std::optional<Film> film =
        renderReference(scene.name, settings, words, prepare, keepGoing);
    if (!film) return std::nullopt;
    described.seconds = watch.seconds();
    fs::create_directories(folder);
    fs::remove(label); // so that no label is ever beside another's picture
    writePicture(picture, *film, {.tone = {}, .statistics = true});
    writePicture(folder / (name + ".png"), *film, {});
    const std::string text = labelOf(scene).dump(2) + "\n";
    writeFileAtomically(label, std::as_bytes(std::span(text)));
    // Read back, so that a study that goes on measures against the very same values.
    compare::Picture written = compare::readPicture(picture);
    describeError(written, described);
    return written;
}

void describeError(const compare::Picture& picture, Reference& reference) {
    const double epsilon = compare::relativeEpsilon(picture);
    double relative = 0, variance = 0, sum = 0;
    for (const PixelStatistics& p : picture.film->pixels)
        for (int c = 0; c < 3; ++c) {
            const double v = p.varianceOfMean()[c];
            if (v > 0) relative += v / (p.mean[c] * p.mean[c] + epsilon);
            sum += p.mean[c];
        }
    // Channels of a pixel are nearly proportional: their standard errors add.
    for (const PixelStatistics& p : picture.film->pixels) {
        const glm::dvec3 sigma = glm::sqrt(p.varianceOfMean());
        variance += (sigma.x + sigma.y + sigma.z) * (sigma.x + sigma.y + sigma.z);
    }
    reference.relMse = relative / (3 * double(picture.film->pixels.size()));
    reference.meanError = sum > 0 ? std::sqrt(variance) / sum : 0;
}

} // namespace stromboli::study
