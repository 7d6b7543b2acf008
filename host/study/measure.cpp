#include "host/study/measure.hpp"

#include "host/bench/measuring.hpp"
#include "host/compare/metrics.hpp"
#include "host/core/system.hpp"
#include "host/render/sampling_session.hpp"

#include <fmt/format.h>

#include <numeric>

namespace stromboli::study {

ExpectedTime::ExpectedTime(const Study& study)
    : referencesLeft_(int(study.scenes.size())),
      referenceOverRun_(double(study.settings.referenceSamples) /
                        double(study.settings.sampleCounts.back())) {
    for (const SceneStudy& scene : study.scenes) {
        for (const Configuration& c : study.settings.configurations)
            runsLeft_[{scene.name, c.name}] = int(study.settings.seeds);
        for (const Run& run : scene.runs)
            --runsLeft_[{scene.name, run.configuration}];
    }
}

void ExpectedTime::runTook(const std::string& scene, const std::string& configuration,
                           double seconds) {
    --runsLeft_[{scene, configuration}];
    runs_[{scene, configuration}].add(seconds);
    scenes_[scene].add(seconds);
    all_.add(seconds);
    done_ += seconds;
}

void ExpectedTime::referenceTook(double seconds, double making) {
    --referencesLeft_;
    references_.add(making);
    done_ += seconds;
}

std::optional<double> ExpectedTime::runSeconds(const std::string& scene,
                                               const std::string& configuration) const {
    const auto mean = [](const Mean& m) { return m.sum / m.count; };
    if (const auto run = runs_.find({scene, configuration}); run != runs_.end())
        return mean(run->second);
    if (const auto found = scenes_.find(scene); found != scenes_.end()) return mean(found->second);
    if (all_.count > 0) return mean(all_);
    if (references_.count > 0) return mean(references_) / referenceOverRun_;
    return std::nullopt;
}

std::optional<double> ExpectedTime::referenceSeconds() const {
    if (references_.count > 0) return references_.sum / references_.count;
    if (all_.count > 0) return referenceOverRun_ * all_.sum / all_.count;
    return std::nullopt;
}

std::optional<double> ExpectedTime::secondsLeft() const {
    double left = 0;
    for (const auto& [name, count] : runsLeft_) {
        if (count <= 0) continue;
        const auto seconds = runSeconds(name.first, name.second);
        if (!seconds) return std::nullopt;
        left += count * *seconds;
    }
    if (referencesLeft_ > 0) {
        const auto seconds = referenceSeconds();
        if (!seconds) return std::nullopt;
        left += referencesLeft_ * *seconds;
    }
    return left;
}

namespace {

double meanOfChannels(const compare::Picture& picture) {
    double sum = 0;
    for (const glm::dvec3& c : picture.rgb)
        sum += c.x + c.y + c.z;
    return sum / (3 * double(picture.rgb.size()));
}

/// The driver compiles what it has put off until the first dispatch.
void warmUp(const PreparedRender& render) {
    render.backend->sampleAlone(0, 0);
}

/// Time since the last step at the pace of the work so far.
bool wouldTakeTooLong(const std::vector<Point>& points, double growth, const StudySettings& s) {
    return !points.empty() && points.back().wallSeconds * growth > s.mostSecondsPerRun;
}

/// One render, each sample count continuing the last.
std::optional<Run> growSamples(const RunPlan& plan, const PreparedRender& render,
                               const KeepGoing& keepGoing, const TakeFilm& takeFilm) {
    const StudySettings& s = plan.settings;
    warmUp(render);
    const uint64_t raysBefore = render.backend->counters().rays;
    Film film(render.settings.area);
    std::vector<PixelTarget> targets(film.pixels.size());
    Run run{plan.configuration.name, plan.seed, {}, false};
    double wallSeconds = 0, cpuSeconds = 0;
    for (const uint32_t samples : s.sampleCounts) {
        if (!run.points.empty() &&
            wouldTakeTooLong(run.points, samples / run.points.back().effort, s)) {
            run.cutShort = true;
            break;
        }
        for (uint32_t i = 0; i < targets.size(); ++i)
            targets[i] = {i, samples};
        bool stopped = false;
        const Stopwatch wall;
        const bench::CpuClock cpu;
        render.backend->sample(targets, film, [&](uint64_t) {
            stopped = !keepGoing(wallSeconds + wall.seconds());
            return !stopped;
        });
        if (stopped) return std::nullopt;
        wallSeconds += wall.seconds();
        cpuSeconds += cpu.seconds();
        Point point = pointOf(film, plan.reference);
        point.effort = samples;
        point.wallSeconds = wallSeconds;
        point.cpuSeconds = cpuSeconds;
        point.rays = render.backend->counters().rays - raysBefore;
        run.points.push_back(point);
        takeFilm(point, film);
    }
    return run;
}

/// One of the renders that growRenders makes.
struct Step {
    double effort;
    uint32_t samples; ///< -s
};

/// The steps of a configuration's own option, or the sample counts.
std::vector<Step> stepsOf(const RunPlan& plan) {
    const std::vector<uint32_t>& counts = plan.settings.sampleCounts;
    std::vector<Step> steps;
    if (plan.configuration.effort.empty())
        for (const uint32_t samples : counts)
            steps.push_back({double(samples), samples});
    else // the most of a pixel: far more than any of these steps is meant to need
        for (const double step : plan.configuration.steps)
            steps.push_back({step, 16 * counts.back()});
    return steps;
}

/// The picture by the backend. Empty: stopped.
std::optional<MeasuredPicture> noisyPicture(PreparedRender& render,
                                            const std::function<bool()>& progress) {
    warmUp(render);
    const uint64_t raysBefore = render.backend->counters().rays;
    bool stopped = false;
    const Stopwatch wall;
    const bench::CpuClock cpu;
    RenderOutcome outcome;
    MeasuredPicture picture;
    picture.film = stromboli::render(
        *render.backend, render.settings,
        [&](const RenderProgress&) {
            stopped = !progress();
            return !stopped;
        },
        &outcome);
    if (stopped) return std::nullopt;
    picture.wallSeconds = wall.seconds();
    picture.cpuSeconds = cpu.seconds();
    picture.noise = outcome.noise;
    picture.rays = render.backend->counters().rays - raysBefore;
    return picture;
}

/// A render of its own for each step.
std::optional<Run> growRenders(const RunPlan& plan, const Prepare& prepare,
                               const KeepGoing& keepGoing, const TakeFilm& takeFilm) {
    const StudySettings& s = plan.settings;
    Run run{plan.configuration.name, plan.seed, {}, false};
    double secondsBefore = 0;
    for (const Step& step : stepsOf(plan)) {
        // Halving a tolerance takes four times the samples.
        const double growth = !plan.configuration.effort.empty() || run.points.empty()
                                  ? 4
                                  : step.effort / run.points.back().effort;
        if (wouldTakeTooLong(run.points, growth, s)) {
            run.cutShort = true;
            break;
        }
        PreparedRender render = prepare(
            plan.scene, renderOptions(s, plan.configuration, step.effort, plan.seed, step.samples));
        const Stopwatch wall;
        const auto progress = [&] { return keepGoing(secondsBefore + wall.seconds()); };
        const std::optional<MeasuredPicture> picture =
            render.denoised ? render.denoised(progress) : noisyPicture(render, progress);
        if (!picture) return std::nullopt;
        const Film& film = picture->film;
        Point point = pointOf(film, plan.reference);
        point.wallSeconds = picture->wallSeconds;
        point.cpuSeconds = picture->cpuSeconds;
        secondsBefore += point.wallSeconds;
        point.noise = picture->noise;
        point.effort = step.effort;
        point.rays = picture->rays;
        run.points.push_back(point);
        takeFilm(point, film);
    }
    return run;
}

} // namespace

std::vector<std::string> renderOptions(const StudySettings& settings, const Configuration& c,
                                       double step, uint32_t seed, uint32_t samples) {
    std::vector<std::string> words = splitOptions(settings.commonOptions);
    for (const std::string& word : optionsAt(c, step))
        words.push_back(word);
    for (const std::string& word : {std::string("--seed"), fmt::format("{}", seed),
                                    std::string("-s"), fmt::format("{}", samples)})
        words.push_back(word);
    return words;
}

Point pointOf(const Film& film, const compare::Picture& reference) {
    compare::Picture picture(film.width, film.height);
    Point point;
    for (size_t i = 0; i < picture.rgb.size(); ++i) {
        picture.rgb[i] = film.pixels[i].mean;
        point.samples += film.pixels[i].taken();
        point.rejected += film.pixels[i].rejected;
    }
    point.samples *= double(film.branches) / double(picture.rgb.size());
    const compare::LinearErrors errors = compare::linearErrors(reference, picture);
    point.relMse = errors.relMse;
    point.mse = errors.mse;
    const double mean = meanOfChannels(reference);
    point.bias = mean > 0 ? meanOfChannels(picture) / mean - 1 : 0;
    return point;
}

std::optional<Run> measureRun(const RunPlan& plan, const Prepare& prepare,
                              const KeepGoing& keepGoing, const TakeFilm& takeFilm) {
    if (plan.configuration.effort.empty()) {
        const StudySettings& s = plan.settings;
        const PreparedRender render = prepare(
            plan.scene, renderOptions(s, plan.configuration, 0, plan.seed, s.sampleCounts.back()));
        const RenderSettings& r = render.settings;
        // How many branches a sample has depends on the count, too.
        const bool grows = !render.denoised && !r.budget.spreads() && !r.budget.adaptive.enabled &&
                           r.estimator.branches == 1;
        if (grows) return growSamples(plan, render, keepGoing, takeFilm);
    }
    return growRenders(plan, prepare, keepGoing, takeFilm);
}

} // namespace stromboli::study
