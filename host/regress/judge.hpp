#pragma once

#include "host/compare/comparison.hpp"
#include "host/regress/suite.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::regress {

enum class Verdict {
    Agrees,
    Differs,   ///< by the statistical test or by a limit
    Undecided, ///< no difference was found, but none could have been
    NoGolden,  ///< there is no golden picture to judge by
    Failed,    ///< the picture could not be made
    Updated,   ///< the golden picture was made anew
    NotRun,    ///< the run was stopped before
};
const char* nameOf(Verdict verdict);

/// What became of a picture of the suite.
struct Outcome {
    SuitePicture which;
    Verdict verdict = Verdict::NotRun;
    std::vector<std::string> reasons;              ///< of a verdict that is no success, a line each
    std::vector<std::string> remarks;              ///< budgets that were not kept
    std::optional<compare::Comparison> comparison; ///< with the golden picture, or the one before
    double seconds = 0;                            ///< wall time of loading and rendering
    double megabytes = 0;                          ///< most memory that the process had meanwhile
    /// Of the report's folder: pictures that were written for it.
    std::string goldenPicture, newPicture, flipPicture, differencePicture;
};

/// A whole run.
struct Results {
    Suite suite;
    std::vector<Outcome> outcomes;
    double pictureFalseAlarms = 0; ///< of each statistical test
    std::string device, version, date;

    bool passed() const;
    /// A picture differs, has no golden one or could not be made.
    bool failed() const;
};

/// The level of the statistical test of each picture, if that of `suite` is to hold for all of its
/// `pictures` together (Sidak 1967), however many of them are run.
double falseAlarmsOfEach(const Suite& suite);

/// Judges a picture by the golden one: by the z-tests of `check` where both have variances, and by
/// the picture's limits; where neither can be, by equal values. Throws UsageError where sizes
/// differ.
void judge(const compare::Picture& golden, const compare::Picture& picture, double falseAlarms,
           Outcome& outcome);

/// Remarks on budgets that are not kept.
void noteBudgets(Outcome& outcome);

/// Writes pictures of both, of FLIP and of the signed difference into the folder, and names them in
/// the outcome. Throws OutputError.
void writePictures(const std::filesystem::path& folder, const compare::Picture& golden,
                   const compare::Picture& picture, Outcome& outcome);

} // namespace stromboli::regress
