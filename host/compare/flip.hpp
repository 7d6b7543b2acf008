#pragma once

#include "host/compare/picture.hpp"

namespace stromboli::compare {

/// Pixels per degree of a viewer 0.7 m from a screen 0.7 m wide with 3840 pixels across, the
/// default of the FLIP papers: 0.7 (3840 / 0.7) pi / 180.
inline constexpr double kFlipPixelsPerDegree = 67.0206432765823;

/// Difference as a viewer would see it who flips between the two pictures: FLIP (Andersson et al.
/// 2020), one value in [0, 1] a pixel. Colours are filtered by the eye's contrast sensitivity and
/// compared in a uniform space; differences of edges and points amplify that. Values are linear
/// and cut off to [0, 1], which is what the screen shows. Pictures have the same size.
std::vector<double> flipMap(const Picture& reference, const Picture& picture,
                            double pixelsPerDegree = kFlipPixelsPerDegree);

struct HdrFlip {
    std::vector<double> map; ///< largest over the exposures
    double startStops = 0, stopStops = 0;
    int exposures = 0;
};

/// HDR-FLIP (Andersson et al. 2021): the largest FLIP over a range of exposures through a tone
/// curve. The exposures, about one stop apart, range from where the reference's brightest pixel
/// is just not white to where its median is.
HdrFlip hdrFlipMap(const Picture& reference, const Picture& picture,
                   double pixelsPerDegree = kFlipPixelsPerDegree);

double meanOf(const std::vector<double>& values);

} // namespace stromboli::compare
