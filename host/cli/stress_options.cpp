#include "host/cli/declared_command.hpp"
#include "host/stress/case.hpp"

namespace stromboli {
namespace {

Words caseNames() {
    Words names;
    for (const stress::Case& one : stress::allCases())
        names.push_back(one.name);
    return names;
}

} // namespace

void declareStress(DeclaredCommand& c) {
    StressOptions& o = c.options.stress;
    c.list.group("Cases");
    c.list.list("CASE", "", "names or numbers from --list", o.cases)
        .usually("all")
        .proposes(caseNames());
    c.list.flag("--list", "list the cases and run none", o.list);
    c.list.flag("--full",
                "as much of each as docs/hard_cases.md states (1e8 rays, 1e7 bounces for each "
                "scale): some ten minutes on two cores, instead of a part of it, half a minute",
                o.full);
    c.list.group("Output");
    c.list.text("--json", "FILE.json", "write the results as JSON", o.jsonFile)
        .proposes(Proposed::Files);
    declareDevice(c);
    declareHost(c);
    c.finish = [&c, &o] {
        const std::string ignored = o.list ? c.givenOf({"--full", "--json", "--device", "-t"}) : "";
        if (!ignored.empty())
            c.options.remarks.push_back("--list runs nothing: ignored: " + ignored);
    };
}

} // namespace stromboli
