// `stress`: the hard cases of docs/hard_cases.md on the device.
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/json.hpp"
#include "host/core/system.hpp"
#include "host/stress/case.hpp"
#include "host/stress/device_subject.hpp"
#include "host/version/version.hpp"
#include "host/vulkan/device.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace stromboli {
namespace {

using stress::Case;
using stress::Outcome;

Words caseNames() {
    Words names;
    for (const stress::Case& one : stress::allCases())
        names.push_back(one.name);
    return names;
}

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
    /// The time left if all cases take the mean time of those that are done; empty before the first
    /// is.
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

void declareStress(DeclaredCommand& c) {
    const auto o = std::make_shared<StressOptions>();
    c.list.group("Cases");
    c.list.list("CASE", "", "names or numbers from --list", o->cases)
        .usually("all")
        .proposes(caseNames());
    c.list.flag("--list", "list the cases and run none", o->list);
    c.list.flag("--full",
                "as much of each as docs/hard_cases.md states (1e8 rays, 1e7 bounces for each "
                "scale): some ten minutes on two cores, instead of a part of it, half a minute",
                o->full);
    c.list.group("Output");
    c.list.text("--json", "FILE.json", "write the results as JSON", o->jsonFile)
        .proposes(Proposed::Files);
    declareDevice(c.list, o->device);
    declareHost(c);
    c.finish = [&c, o] {
        const std::string ignored =
            o->list ? c.givenOf({"--full", "--json", "--device", "-t"}) : "";
        if (!ignored.empty()) c.host.remarks.push_back("--list runs nothing: ignored: " + ignored);
        return *o;
    };
}

int stressCommand(const StressOptions& options) {
    const std::vector<Case> cases = chosenCases(options.cases);
    if (options.list) {
        for (const Case& c : cases)
            fmt::print("{}", stress::listRow(c));
        return 0;
    }
    if (!options.jsonFile.empty()) checkOutputWritable(options.jsonFile);
    onSignal(OnSignal::Ask);
    const vulkan::OpenDevice open = vulkan::openDevice(options.device, toTerminal().message);
    const vulkan::DeviceDescription& device = open.device->description();
    const bool prints = !isStandardOutput(options.jsonFile);
    if (prints) fmt::print("{}, {}\n", device.name(), device.driver);
    const auto amount = options.full ? stress::Amount::Full : stress::Amount::Quick;
    const std::vector<Outcome> outcomes = runCases(cases, *open.device, amount, prints);
    if (outcomes.size() < cases.size()) {
        logging::warn(
            fmt::format("interrupted after {} of {} cases", outcomes.size(), cases.size()));
        return interruptedExitCode();
    }
    if (!options.jsonFile.empty())
        writeJson(options.jsonFile,
                  stress::toJson({device.name(), device.driver, version(), amount}, outcomes));
    vulkan::requireNoValidationMessages(open);
    const auto failed = std::ranges::count_if(outcomes, std::not_fn(&Outcome::passed));
    if (prints)
        fmt::print("{}: {} of {} cases\n", failed == 0 ? "PASS" : "FAIL",
                   outcomes.size() - size_t(failed), outcomes.size());
    return failed == 0 ? 0 : int(ExitCode::Device);
}

} // namespace stromboli
