#pragma once

#include "host/compare/comparison.hpp"
#include "host/core/named_values.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace stromboli {

/// What a PNG of the difference shows.
enum class DifferenceView { Flip, Relative, Signed };
template <>
inline constexpr auto kNamedValues<DifferenceView> = std::to_array<NamedValue<DifferenceView>>({
    {DifferenceView::Flip, "flip", "FLIP, black 0 to white 1"},
    {DifferenceView::Relative, "relative", "the error that relMSE squares, black 0 to white 1"},
    {DifferenceView::Signed, "signed", "blue where IMG is darker, red where it is brighter"},
});

/// `compare` as understood.
struct CompareOptions {
    std::string reference, picture;
    compare::CompareSettings settings;
    compare::Thresholds thresholds;
    std::string jsonFile;       ///< empty: none; "-": standard output, instead of the text
    std::string differenceFile; ///< empty: none
    DifferenceView show = DifferenceView::Flip;
    std::string varianceFile;        ///< of one sample of the reference; empty: none
    std::optional<uint32_t> samples; ///< of each pixel of the picture, for varianceFile
    double referenceSamples = compare::kReferenceSamples; ///< of each pixel, for varianceFile
    bool familyErrorGiven = false;                        ///< on the command line
};

} // namespace stromboli
