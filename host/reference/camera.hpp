#pragma once

#include "host/reference/bvh.hpp"
#include "host/render/estimator.hpp"
#include "scene/camera/camera.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::reference {

// --- Camera rays ---------------------------------------------------------------------------------

/// The ray through picture coordinates s, t in [0, 1], from the left and from the top, limited to
/// the distances that the camera clips to. onLens: where it leaves from, on the unit disk.
Ray cameraRay(const Camera& camera, double s, double t, const glm::dvec2& onLens = glm::dvec2(0));

// --- Pixel filters -------------------------------------------------------------------------------

struct FilterSample {
    glm::dvec2 place;  ///< from the pixel's upper left corner, in pixels
    double weight = 1; ///< of a filter that is negative in places; its mean is 1
};

/// Places about a pixel, in proportion to the absolute value of its filter.
class FilterSampler {
  public:
    FilterSampler(PixelFilter filter, const FilterShape& shape);

    /// u, v: uniform in [0, 1).
    FilterSample sample(double u, double v) const;

  private:
    /// What a filter that is negative in places is along columns or rows, at a distance from the
    /// middle.
    double at(double x) const;
    /// Its integral over a stretch.
    double integral(double from, double to) const;
    void integrate();
    struct Weighted {
        double x, sign;
    };
    Weighted sampleSigned(double u) const;

    /// A part of the filter that has one sign, and the integral of the absolute value up to its
    /// end, those before it included.
    struct Stretch {
        double from, to, sign, sum;
    };

    PixelFilter filter_;
    FilterShape shape_;
    double radius_ = 0;
    std::vector<Stretch> stretches_; ///< the positive ones first, so that signs are spread evenly
    double ratio_ = 1;               ///< of the absolute value's integral to the filter's
};

} // namespace stromboli::reference
