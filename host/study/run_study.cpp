#include "host/study/run_study.hpp"

#include "host/compare/flip.hpp"
#include "host/compare/metrics.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/json.hpp"
#include "host/core/system.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/sampling_session.hpp"
#include "host/study/journal.hpp"
#include "host/study/measure.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
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

namespace {

namespace fs = std::filesystem;

/// Letters that no file system minds.
std::string fileName(std::string name) {
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.')
            c = '_';
    return name;
}

bool hasRun(const SceneStudy& scene, const std::string& configuration, uint32_t seed) {
    return std::any_of(scene.runs.begin(), scene.runs.end(), [&](const Run& run) {
        return run.configuration == configuration && run.seed == seed;
    });
}

class Conductor {
  public:
    Conductor(const fs::path& folder, Study& study, const StudyHooks& hooks)
        : folder_(folder), study_(study), hooks_(hooks), expected_(study) {}

    bool all() {
        for (SceneStudy& scene : study_.scenes)
            if (!measureScene(scene)) return false;
        return true;
    }

  private:
    bool measureScene(SceneStudy& scene);
    std::optional<compare::Picture> reference(SceneStudy& scene);
    bool measure(SceneStudy& scene, const Configuration& c, uint32_t seed,
                 const compare::Picture& reference);
    void writePictures(const SceneStudy& scene, const Configuration& c, const Point& point,
                       const Film& film, const compare::Picture& reference);
    void save() const;
    /// `expected`: of the step under way; `spent`: in it.
    bool show(const std::string& doing, std::optional<double> expected, double spent) const;

    const fs::path& folder_;
    Study& study_;
    const StudyHooks& hooks_;
    ExpectedTime expected_;
};

bool Conductor::measureScene(SceneStudy& scene) {
    const std::optional<compare::Picture> picture = reference(scene);
    if (!picture) return false;
    scene.width = picture->width;
    scene.height = picture->height;
    // Seed by seed: a study that is stopped early has something of every configuration, and slow
    // changes of the machine's speed do not favour one of them.
    for (uint32_t seed = 1; seed <= study_.settings.seeds; ++seed)
        for (const Configuration& c : study_.settings.configurations)
            if (!hasRun(scene, c.name, seed) && !measure(scene, c, seed, *picture)) return false;
    return true;
}

std::optional<compare::Picture> Conductor::reference(SceneStudy& scene) {
    const Stopwatch watch;
    const auto picture = referencePicture(
        folder_ / "references", fileName(scene.name), study_.settings, hooks_.prepare,
        [&](double share) {
            return show(scene.name + ": reference",
                        share > 0 ? std::optional(watch.seconds() / share) : std::nullopt,
                        watch.seconds());
        },
        scene);
    if (picture) expected_.referenceTook(watch.seconds(), scene.reference.seconds);
    return picture;
}

bool Conductor::measure(SceneStudy& scene, const Configuration& c, uint32_t seed,
                        const compare::Picture& reference) {
    const Stopwatch watch;
    const std::string doing =
        fmt::format("{}: {}, seed {} of {}", scene.name, c.name, seed, study_.settings.seeds);
    const std::optional<double> expected = expected_.runSeconds(scene.name, c.name);
    if (!show(doing, expected, 0)) return false;
    const std::optional<Run> run = measureRun(
        {scene.name, c, seed, study_.settings, reference}, hooks_.prepare,
        [&](double) { return show(doing, expected, watch.seconds()); },
        [&](const Point& point, const Film& film) {
            if (seed == 1) writePictures(scene, c, point, film, reference);
        });
    if (!run) return false;
    scene.runs.push_back(*run);
    expected_.runTook(scene.name, c.name, watch.seconds());
    save();
    return true;
}

/// Averages of 2 x 2 pixels, which a report shows better than single pixels' noise.
std::vector<double> halved(const std::vector<double>& values, uint32_t width, uint32_t height) {
    const uint32_t w = (width + 1) / 2, h = (height + 1) / 2;
    std::vector<double> out(size_t(w) * h), counts(out.size());
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const size_t to = size_t(y / 2) * w + x / 2;
            out[to] += values[size_t(y) * width + x];
            counts[to] += 1;
        }
    for (size_t i = 0; i < out.size(); ++i)
        out[i] /= counts[i];
    return out;
}

void Conductor::writePictures(const SceneStudy& scene, const Configuration& c, const Point& point,
                              const Film& film, const compare::Picture& reference) {
    const auto& counts = study_.settings.sampleCounts;
    const size_t index =
        c.effort.empty()
            ? size_t(std::find(counts.begin(), counts.end(), uint32_t(point.effort)) -
                     counts.begin())
            : size_t(std::find(c.steps.begin(), c.steps.end(), point.effort) - c.steps.begin());
    const fs::path base = folder_ / pictureName(scene.name, c.name, index);
    fs::create_directories(base.parent_path());
    writePicture(base.string() + ".png", film, {});
    compare::Picture means(film.width, film.height);
    uint32_t least = std::numeric_limits<uint32_t>::max(), most = 1;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        means.rgb[i] = film.pixels[i].mean;
        least = std::min(least, film.pixels[i].taken());
        most = std::max(most, film.pixels[i].taken());
    }
    std::vector<double> errors =
        halved(compare::relativeErrorMap(reference, means), film.width, film.height);
    for (double& error : errors)
        error = std::sqrt(error);
    const uint32_t w = (film.width + 1) / 2, h = (film.height + 1) / 2;
    writePng(base.string() + "-error.png", compare::falseColor(errors, w, h, 1),
             PngColorSpace::Srgb);
    if (!c.effort.empty() || least < most)
        writePng(base.string() + "-samples.png", ratePicture(film, most), PngColorSpace::Srgb);
}

void Conductor::save() const {
    const std::string text = toJson(study_).dump(1) + "\n";
    writeFileAtomically(folder_ / "study.json", std::as_bytes(std::span(text)), Sync::Later);
}

bool Conductor::show(const std::string& doing, std::optional<double> expected, double spent) const {
    if (hooks_.stopped()) return false;
    StudyProgress progress{doing, 0, std::nullopt};
    std::optional<double> left = expected_.secondsLeft();
    if (!left && expected) { // in the first reference, which foretells the rest
        ExpectedTime guess = expected_;
        guess.referenceTook(*expected, *expected);
        left = *guess.secondsLeft() + *expected;
    }
    if (left) {
        const double inStep = expected ? std::min(spent, *expected) : 0;
        const double rest = std::max(*left - inStep, 0.0), done = expected_.secondsDone() + spent;
        progress.secondsLeft = rest;
        progress.share = done + rest > 0 ? done / (done + rest) : 0;
    }
    hooks_.show(progress);
    return true;
}

} // namespace

std::string pictureName(const std::string& scene, const std::string& configuration,
                        size_t effortIndex) {
    return fmt::format("pictures/{}-{}-{}", fileName(scene), fileName(configuration), effortIndex);
}

bool runStudy(const fs::path& folder, Study& study, const StudyHooks& hooks) {
    fs::create_directories(folder);
    return Conductor(folder, study, hooks).all();
}

} // namespace stromboli::study
