#include "host/cli/declared_command.hpp"

namespace stromboli {

void declareStress(DeclaredCommand& c) {
    StressOptions& o = c.options.stress;
    c.list.group("Cases");
    c.list.list("CASE", "", "names or numbers from --list", o.cases).usually("all");
    c.list.flag("--list", "list the cases and run none", o.list);
    c.list.flag("--full",
                "as much of each as docs/hard_cases.md states (1e8 rays, 1e7 bounces for each "
                "scale): some ten minutes on two cores, instead of a part of it, half a minute",
                o.full);
    c.list.group("Output");
    c.list.text("--json", "FILE.json", "write the results as JSON", o.jsonFile);
    declareDevice(c);
    declareHost(c);
}

} // namespace stromboli
