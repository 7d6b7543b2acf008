#include "host/cli/stress_options.hpp"

#include <CLI/CLI.hpp>

namespace stromboli {

void declareStress(CLI::App& app, StressOptions& options) {
    app.add_option("CASE", options.cases, "names or numbers from --list [all]")->group("Cases");
    app.add_flag("--list", options.list, "list the cases and run none")->group("Cases");
    app.add_flag("--full", options.full,
                 "as much of each as docs/hard_cases.md states (1e8 rays, 1e7 bounces for each "
                 "scale): some ten minutes on two cores [a part of it, half a minute]")
        ->group("Cases");
    app.add_option("--json", options.jsonFile, "write the results as JSON")
        ->type_name("FILE.json")
        ->group("Output");
}

} // namespace stromboli
