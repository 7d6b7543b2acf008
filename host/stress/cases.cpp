#include "host/stress/case.hpp"

#include <algorithm>

namespace stromboli::stress {

const std::vector<Case>& allCases() {
    static const std::vector<Case> all = [] {
        std::vector<Case> cases;
        for (const auto group :
             {edgeCases, intersectionCases, closedCases, offsetCases, scaleCases, randomCases,
              furnaceCases, estimatorCases, filmCases, agreementCases, arithmeticCases,
              environmentCases, materialCases, textureCases, tangentCases, instanceCases})
            std::ranges::move(group(), std::back_inserter(cases));
        // By their first number.
        std::ranges::stable_sort(cases, {}, [](const Case& c) { return std::stoi(c.numbers); });
        return cases;
    }();
    return all;
}

} // namespace stromboli::stress
