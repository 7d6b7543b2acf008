#include "scene/pbrt/cloud.hpp"

#include "scene/pbrt/medium_grids.hpp"
#include "scene/pbrt/pattern.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {
namespace {

/// How the noise changes, by differences over a hundredth.
glm::dvec3 slopeOfNoise(const glm::dvec3& p) {
    constexpr double kStep = 0.01;
    const double here = noise(p);
    return glm::dvec3(noise(p + glm::dvec3(kStep, 0, 0)) - here,
                      noise(p + glm::dvec3(0, kStep, 0)) - here,
                      noise(p + glm::dvec3(0, 0, kStep)) - here) /
           kStep;
}

struct Cloud {
    double density = 1, wispiness = 1, frequency = 5;

    double at(const glm::dvec3& place) const {
        if (place.y <= 0) return 1;
        if (place.y >= 1) return 0;
        // Below one half of the height there is more.
        const double thinned = std::clamp((1 - place.y) * 4.5 * density * shape(place), 0.0, 1.0);
        return std::min(thinned + 2 * std::max(0.5 - place.y, 0.0), 1.0);
    }

    double shape(const glm::dvec3& place) const {
        if (density <= 0) return 0;
        constexpr double kFiner = 1.99; // than the octave before
        glm::dvec3 p = frequency * place;
        constexpr double kMost = 1e9; // farther off, numbers have no digits for cells of noise
        for (const int axis : {0, 1, 2})
            if (!(std::abs(p[axis]) < kMost)) return 0;
        double shift = 0.05 * wispiness, scale = 10;
        for (int i = 0; wispiness > 0 && i < 2; ++i, shift /= 2, scale *= kFiner)
            p += shift * slopeOfNoise(scale * p);
        double sum = 0, weight = 0.5;
        scale = 1;
        for (int octave = 0; octave < 5; ++octave, weight /= 2, scale *= kFiner)
            sum += weight * noise(scale * p);
        return sum;
    }
};

} // namespace

DensityGrid cloudOf(const Parameters& p, const glm::dmat4& worldFromMedium) {
    Cloud cloud;
    cloud.density = p.number("density", 1, 0, 1e6);
    cloud.wispiness = p.number("wispiness", 1, 0, 1e6);
    cloud.frequency = p.number("frequency", 5, 0, 1e6);
    const glm::dvec3 low = p.vector("p0").value_or(glm::dvec3(0));
    const glm::dvec3 size = p.vector("p1").value_or(glm::dvec3(1)) - low;
    constexpr double kMostCells = 96; // of a side
    const glm::dvec3 sides = glm::abs(size);
    for (const int axis : {0, 1, 2})
        if (!(sides[axis] > 0 && sides[axis] < 1e30)) p.place().fail("has a box without a volume");
    const double longest = std::max({sides.x, sides.y, sides.z});
    const glm::dvec3 cells = glm::clamp(glm::round(kMostCells * sides / longest), 1.0, kMostCells);
    DensityGrid grid = emptyDensity(p, worldFromMedium, glm::uvec3(cells));
    const glm::uvec3 count = grid.size;
    grid.values.resize(size_t(count.x) * count.y * count.z);
    tbb::parallel_for(0u, count.y * count.z, [&](uint32_t row) {
        for (uint32_t x = 0; x < count.x; ++x) {
            const glm::dvec3 cell(x, row % count.y, row / count.y);
            const glm::dvec3 place = low + size * (cell + 0.5) / glm::dvec3(count);
            grid.values[size_t(row) * count.x + x] = float(cloud.at(place));
        }
    });
    return grid;
}

} // namespace stromboli::pbrt
