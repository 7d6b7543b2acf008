#pragma once

#include "host/stress/run.hpp"

#include <string>
#include <vector>

namespace stromboli::stress {

/// What a case found.
struct Finding {
    double measured = 0;
    double bound = 0;
    uint64_t trials = 0;
    std::string where; ///< what was worst; may be empty

    bool passed() const { return measured <= bound; } ///< NaN does not
};

/// A hard case: a property that naive code lacks.
struct Case {
    std::string name;
    std::string numbers;  ///< in docs/hard_cases.md
    std::string property; ///< what holds if it passes
    std::string measure;  ///< what `measured` is
    std::string trial;    ///< what `trials` counts
    Finding (*run)(Run& run);
};

/// All of them, in the order of docs/hard_cases.md. The groups are one file each.
const std::vector<Case>& allCases();

std::vector<Case> edgeCases();         ///< rays at edges and corners
std::vector<Case> intersectionCases(); ///< primitives and hierarchies that are hard to hit
std::vector<Case> closedCases();       ///< rays that leave surfaces, many times over
std::vector<Case> offsetCases();       ///< where rays start and end
std::vector<Case> scaleCases();        ///< scenes of any size, anywhere
std::vector<Case> randomCases();
std::vector<Case> furnaceCases();    ///< pictures that are one colour
std::vector<Case> estimatorCases();  ///< ways to the same mean
std::vector<Case> filmCases();       ///< sums of samples, and how the work is cut
std::vector<Case> agreementCases();  ///< device against reference
std::vector<Case> arithmeticCases(); ///< what is taken for granted of floats
std::vector<Case> environmentCases();
std::vector<Case> materialCases(); ///< parameters at their ends, layers, nested volumes
std::vector<Case> instanceCases(); ///< meshes met through placements
std::vector<Case> textureCases();
std::vector<Case> tangentCases(); ///< normal maps without a frame

} // namespace stromboli::stress
