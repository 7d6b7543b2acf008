#pragma once

#include "host/compare/metrics.hpp"
#include "host/film/image_file.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::compare {

// --- FLIP ----------------------------------------------------------------------------------------

/// One channel of a picture, rows from the top.
struct Plane {
    uint32_t width = 0, height = 0;
    std::vector<double> values;

    Plane() = default;
    Plane(uint32_t w, uint32_t h) : width(w), height(h), values(size_t(w) * h) {}
};

/// Weights at -r, ..., 0, ..., r.
using Kernel = std::vector<double>;

/// exp(-x^2 / (2 sigma^2)) at whole x up to `radius`, with sum 1.
Kernel gaussian(double sigma, int radius);

/// sum of alongX[i] alongY[j] p(x + i, y + j): a correlation, beyond the edges of the plane the
/// nearest value of it.
Plane filter(const Plane& plane, const Kernel& alongX, const Kernel& alongY);

/// Linear sRGB to YCxCz, the opponent space of iCAM (Moroney 2002; FLIP paper, section 4.1) for
/// the white of sRGB: white has Y = 100, Cx = Cz = 0.
glm::dvec3 yccFromLinear(const glm::dvec3& rgb);
glm::dvec3 linearFromYcc(const glm::dvec3& ycc);

/// CIE L*a*b* of linear sRGB, a and b scaled by L / 100: the Hunt effect, by which colours are
/// less colourful in the dark.
glm::dvec3 huntLabFromLinear(const glm::dvec3& rgb);

/// |dL| + sqrt(da^2 + db^2) (Abasi et al. 2020), a distance for large differences of colour.
double hyAb(const glm::dvec3& a, const glm::dvec3& b);

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

// --- False colours -------------------------------------------------------------------------------

/// Cubehelix (Green 2011; start 0.5, -1.5 rotations, hue 1, gamma 1): 0 is black, 1 is white, and
/// the lightness grows evenly between, so that the picture reads in grey too. Clamps its argument.
glm::dvec3 cubehelix(double value);

/// -1 is blue, 0 is white, 1 is red, linear in between. Clamps its argument.
glm::dvec3 blueWhiteRed(double value);

/// One value a pixel through cubehelix(value / top).
ByteImage falseColor(std::span<const double> values, uint32_t width, uint32_t height, double top);

/// (x - r) / (r + 0.1 m) in luminance, m the mean of the reference, through blueWhiteRed: red
/// where the picture is too bright; the ends of the colours are at -1 and 1.
ByteImage signedDifference(const Picture& reference, const Picture& picture);

} // namespace stromboli::compare
