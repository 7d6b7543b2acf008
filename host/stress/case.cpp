#include "host/stress/case.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace stromboli::stress {

// --- A run ---------------------------------------------------------------------------------------

Picture Run::render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                    const KernelTuning& tuning) const {
    Picture picture = subject_.render(scene, camera, settings, tuning,
                                      [this](const RenderProgress&) { return !goOn_ || goOn_(); });
    goOn(); // a picture that was cut short is no picture
    return picture;
}

// --- All cases -----------------------------------------------------------------------------------

const std::vector<Case>& allCases() {
    static const std::vector<Case> all = [] {
        std::vector<Case> cases;
        for (const auto group : {edgeCases, intersectionCases, closedCases, offsetCases, scaleCases,
                                 randomCases, furnaceCases, estimatorCases, filmCases,
                                 agreementCases, arithmeticCases, environmentCases, materialCases,
                                 mediumCases, textureCases, tangentCases, instanceCases})
            std::ranges::move(group(), std::back_inserter(cases));
        // By their first number.
        std::ranges::stable_sort(cases, {}, [](const Case& c) { return std::stoi(c.numbers); });
        return cases;
    }();
    return all;
}

// --- Reports -------------------------------------------------------------------------------------

namespace {

constexpr const char* kRow = "{:<4}  {:<17}  {:>6}  {:>10}  {:>8}  {:<18}  {:>8} {:<8}  {}\n";

/// "0", "1.2e-07", "5e+07".
std::string brief(double x) {
    return fmt::format("{:.3g}", x);
}

} // namespace

std::string tableHead() {
    return fmt::format(kRow, "", "case", "no.", "measured", "bound", "", "of", "", "property");
}

std::string tableRow(const Outcome& o) {
    const Case& c = o.which;
    if (!o.error.empty())
        return fmt::format(kRow, "FAIL", c.name, c.numbers, "-", "-", "", "-", "", o.error);
    const Finding& f = o.finding;
    const bool passed = o.passed();
    const std::string property =
        passed || f.where.empty() ? c.property : c.property + "; worst: " + f.where;
    return fmt::format(kRow, passed ? "pass" : "FAIL", c.name, c.numbers, brief(f.measured),
                       brief(f.bound), c.measure, brief(double(f.trials)), c.trial, property);
}

std::string listRow(const Case& c) {
    return fmt::format("{:<17}  {:>6}  {}\n", c.name, c.numbers, c.property);
}

Json toJson(const Circumstances& circumstances, const std::vector<Outcome>& outcomes) {
    Json cases = Json::array();
    for (const Outcome& o : outcomes) {
        Json entry = {{"name", o.which.name},         {"numbers", o.which.numbers},
                      {"property", o.which.property}, {"measure", o.which.measure},
                      {"trial", o.which.trial},       {"passed", o.passed()}};
        if (o.error.empty()) {
            entry["measured"] = o.finding.measured;
            entry["bound"] = o.finding.bound;
            entry["trials"] = o.finding.trials;
            entry["where"] = o.finding.where;
        } else {
            entry["error"] = o.error;
        }
        cases.push_back(std::move(entry));
    }
    return {{"device", circumstances.device},
            {"driver", circumstances.driver},
            {"version", circumstances.version},
            {"full", circumstances.amount == Amount::Full},
            {"passed", std::ranges::all_of(outcomes, &Outcome::passed)},
            {"cases", std::move(cases)}};
}

} // namespace stromboli::stress
