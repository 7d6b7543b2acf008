#pragma once

#include <string>
#include <vector>

namespace stromboli::study {

/// A way to render, by name: options of `stromboli render` on top of its defaults.
struct Configuration {
    std::string name;
    std::string options; ///< as on a command line
    std::string what;    ///< one line for the report
    /// Empty: effort is the sample count. Otherwise an option with {} for a number, and the numbers
    /// in order of growing effort: each is a render of its own, as of a tolerance.
    std::string effort = {};
    std::vector<double> steps = {};
};

/// Every configuration that `study` knows; to add one, add a line to the table.
const std::vector<Configuration>& knownConfigurations();

/// A list of names, and of "NAME=OPTIONS" for configurations of one's own; an option in it that
/// holds {a,b,...} is the effort, its steps a, b, ... . Throws UsageError for an unknown name or
/// one that is there twice.
std::vector<Configuration> chooseConfigurations(const std::vector<std::string>& wanted);

/// An option line at white space; no quoting.
std::vector<std::string> splitOptions(const std::string& line);

/// The options of a configuration at one step; `step` is ignored if the effort is samples.
std::vector<std::string> optionsAt(const Configuration& configuration, double step);

} // namespace stromboli::study
