#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/core/log.hpp"
#include "host/core/output.hpp"
#include "host/core/status_line.hpp"
#include "host/core/stopwatch.hpp"
#include "host/stress/device_subject.hpp"
#include "host/stress/report.hpp"
#include "host/version/version.hpp"
#include "host/vulkan/open_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace stromboli {
namespace {

using stress::Case;
using stress::Outcome;

/// Names the case that runs and says how long the others may take, in the status line.
class CaseLine {
  public:
    CaseLine() = default;
    ~CaseLine() { status_line::clear(); }
    CaseLine(const CaseLine&) = delete;
    CaseLine& operator=(const CaseLine&) = delete;

    void show(const std::string& name, size_t number, size_t count) {
        nowDoing(fmt::format("trying {}", name), StatusLine::OfOthers);
        status_line::draw(
            fmt::format("{} of {}: {}{}", number, count, name, timeLeft(number, count)));
    }

  private:
    /// As if all cases took the mean time of those that are done; nothing before the first is.
    std::string timeLeft(size_t number, size_t count) const {
        if (number == 1) return "";
        const double each = watch_.seconds() / double(number - 1);
        return fmt::format(", about {} left", formatDuration(each * double(count - number + 1)));
    }

    Stopwatch watch_;
};

/// "14, 30" has 14 and 30.
bool hasNumber(const Case& c, const std::string& number) {
    return (", " + c.numbers + ",").find(", " + number + ",") != std::string::npos;
}

std::vector<Case> chosenCases(const std::vector<std::string>& wanted) {
    if (wanted.empty()) return stress::allCases();
    std::vector<bool> chosen(stress::allCases().size());
    for (const std::string& word : wanted) {
        bool known = false;
        for (size_t i = 0; i < chosen.size(); ++i) {
            const Case& c = stress::allCases()[i];
            if (c.name != word && !hasNumber(c, word)) continue;
            chosen[i] = known = true;
        }
        if (!known)
            throw UsageError(
                fmt::format("there is no case '{}'; 'stromboli stress --list' lists them", word));
    }
    std::vector<Case> cases;
    for (size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) cases.push_back(stress::allCases()[i]);
    return cases;
}

Outcome runCase(const Case& which, stress::Run& run) {
    Outcome outcome{which, {}, {}};
    try {
        outcome.finding = which.run(run);
    } catch (const Error& error) { // a finding about the device, too: the other cases go on
        outcome.error = error.what();
    }
    return outcome;
}

void writeJson(const std::string& file, const Json& json) {
    writeOutput(file, json.dump(2) + "\n");
}

/// The table grows as cases end. Stops where the user interrupts.
std::vector<Outcome> runCases(const std::vector<Case>& cases, const vulkan::Device& device,
                              stress::Amount amount, bool prints) {
    stress::DeviceSubject subject(device);
    stress::Run run(subject, amount, [] { return !interrupted(); });
    CaseLine line;
    if (prints) fmt::print("{}", stress::tableHead());
    std::vector<Outcome> outcomes;
    try {
        for (const Case& c : cases) {
            line.show(c.name, outcomes.size() + 1, cases.size());
            outcomes.push_back(runCase(c, run));
            status_line::clear();
            if (!prints) continue;
            fmt::print("{}", stress::tableRow(outcomes.back()));
            std::fflush(stdout);
        }
    } catch (const stress::Interrupted&) {
    }
    return outcomes;
}

} // namespace

int stressCommand(const Options& options) {
    const std::vector<Case> cases = chosenCases(options.stress.cases);
    if (options.stress.list) {
        for (const Case& c : cases)
            fmt::print("{}", stress::listRow(c));
        return 0;
    }
    if (!options.stress.jsonFile.empty()) checkOutputWritable(options.stress.jsonFile);
    onSignal(OnSignal::Ask);
    const vulkan::OpenDevice open = vulkan::openDevice(options.device);
    const vulkan::DeviceDescription& device = open.device->description();
    const bool prints = !isStandardOutput(options.stress.jsonFile);
    if (prints) fmt::print("{}, {}\n", device.name(), device.driver);
    const auto amount = options.stress.full ? stress::Amount::Full : stress::Amount::Quick;
    const std::vector<Outcome> outcomes = runCases(cases, *open.device, amount, prints);
    if (outcomes.size() < cases.size()) {
        logging::warn(
            fmt::format("interrupted after {} of {} cases", outcomes.size(), cases.size()));
        return interruptedExitCode();
    }
    if (!options.stress.jsonFile.empty())
        writeJson(options.stress.jsonFile,
                  stress::toJson({device.name(), device.driver, version(), amount}, outcomes));
    vulkan::requireNoValidationMessages(open);
    const auto failed = std::ranges::count_if(outcomes, std::not_fn(&Outcome::passed));
    if (prints)
        fmt::print("{}: {} of {} cases\n", failed == 0 ? "PASS" : "FAIL",
                   outcomes.size() - size_t(failed), outcomes.size());
    return failed == 0 ? 0 : int(ExitCode::Device);
}

} // namespace stromboli
