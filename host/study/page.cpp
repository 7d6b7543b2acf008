#include "host/study/page.hpp"

#include "embedded/page_html.h"
#include "embedded/page_script.h"
#include "embedded/page_style.h"
#include "embedded/uplot_script.h"
#include "embedded/uplot_style.h"
#include "host/core/page_text.hpp"
#include "host/study/journal.hpp"
#include "host/study/run_study.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>

namespace stromboli::study {

namespace {

namespace fs = std::filesystem;

std::string_view textOf(std::span<const unsigned char> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// null if there is no such file.
Json imageOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return nullptr;
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return "data:image/png;base64," + toBase64(bytes);
}

/// The point nearest in time, as a ratio.
size_t nearestTo(double seconds, const std::vector<Point>& points, bool cpuTime) {
    size_t nearest = 0;
    double distance = INFINITY;
    for (size_t i = 0; i < points.size(); ++i) {
        const double time = cpuTime ? points[i].cpuSeconds : points[i].wallSeconds;
        const double d = std::abs(std::log(std::max(time, 1e-9) / seconds));
        if (d < distance) nearest = i, distance = d;
    }
    return nearest;
}

/// Seconds in which the baseline reaches the target; 0 if it does not.
double timeOfBaseline(const SceneSummary& summary, Clock clock) {
    for (const ConfigurationSummary& c : summary.configurations)
        if (c.name == summary.baseline) return c.by(clock).timeToTarget.value_or(0);
    return 0;
}

Json picturesOf(const Study& study, const SceneStudy& scene, const fs::path& folder) {
    const Clock clock = study.deviceIsCpu ? Clock::Cpu : Clock::Wall;
    const double seconds = timeOfBaseline(summarise(scene, study.settings), clock);
    fs::path reference = folder / scene.reference.file;
    Json pictures = {{"reference", {{"picture", imageOf(reference.replace_extension(".png"))}}}};
    for (const Run& run : scene.runs) {
        if (run.seed != 1 || run.points.empty()) continue;
        const size_t index =
            seconds > 0 ? nearestTo(seconds, run.points, study.deviceIsCpu) : run.points.size() - 1;
        const Point& point = run.points[index];
        const std::string base =
            (folder / pictureName(scene.name, run.configuration, index)).string();
        const Json picture = imageOf(base + ".png");
        if (picture.is_null()) continue;
        pictures[run.configuration] = {{"picture", picture},
                                       {"error", imageOf(base + "-error.png")},
                                       {"samples", imageOf(base + "-samples.png")},
                                       {"samplesPerPixel", point.samples},
                                       {"cpuSeconds", point.cpuSeconds},
                                       {"relMse", point.relMse}};
    }
    return pictures;
}

std::string dataOf(Study study, const fs::path& folder) {
    std::erase_if(study.scenes, [](const SceneStudy& scene) { return scene.runs.empty(); });
    Json json = toJson(study);
    for (size_t i = 0; i < study.scenes.size(); ++i) {
        json["scenes"][i].erase("runs"); // the page shows their summary
        json["scenes"][i]["pictures"] = picturesOf(study, study.scenes[i], folder);
    }
    return forScript(json.dump());
}

} // namespace

std::string toPage(const Study& study, const fs::path& folder) {
    const std::string data = dataOf(study, folder);
    const std::pair<std::string_view, std::string_view> parts[] = {
        {"@@UPLOT_CSS@@", textOf(uplot_style)},
        {"@@STYLE@@", textOf(page_style)},
        {"@@DATA@@", data},
        {"@@UPLOT_JS@@", textOf(uplot_script)},
        {"@@SCRIPT@@", textOf(page_script)},
    };
    return filledIn(textOf(page_html), parts);
}

} // namespace stromboli::study
