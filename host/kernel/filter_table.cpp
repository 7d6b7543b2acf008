#include "host/kernel/filter_table.hpp"

#include "shaders/shared/interface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace stromboli {
namespace {

/// A filter of one coordinate, which is the same on both sides of 0.
struct Profile {
    double radius;
    std::function<double(double)> at; ///< for [0, radius]
};

/// Mitchell and Netravali, Reconstruction filters in computer graphics (1988), equation 8.
Profile cubic(double b, double c) {
    return {2, [b, c](double x) {
                const double x2 = x * x, x3 = x2 * x;
                if (x < 1)
                    return ((12 - 9 * b - 6 * c) * x3 + (-18 + 12 * b + 6 * c) * x2 + 6 - 2 * b) /
                           6;
                return ((-b - 6 * c) * x3 + (6 * b + 30 * c) * x2 + (-12 * b - 48 * c) * x + 8 * b +
                        24 * c) /
                       6;
            }};
}

double sinc(double x) {
    const double turn = std::numbers::pi * x;
    return x < 1e-4 ? 1 - turn * turn / 6 : std::sin(turn) / turn; // the next term is below 1e-16
}

Profile lanczos(uint32_t lobes) {
    return {double(lobes), [lobes](double x) { return sinc(x) * sinc(x / lobes); }};
}

Profile profileOf(PixelFilter filter, const FilterShape& shape) {
    if (filter == PixelFilter::Mitchell) return cubic(shape.b, shape.c);
    if (filter == PixelFilter::CatmullRom) return cubic(0, 0.5);
    return lanczos(shape.lobes);
}

/// Integrals from -radius to each of many equidistant places: of the filter and of its absolute
/// value.
class Integrals {
  public:
    explicit Integrals(const Profile& profile)
        : radius_(profile.radius), filter_(2 * kHalf + 1, 0.0), absolute_(2 * kHalf + 1, 0.0) {
        const double step = radius_ / kHalf;
        for (size_t i = 0; i < 2 * kHalf; ++i) {
            // The rule of Simpson on a step; both halves of the filter have the same sums.
            const size_t fromMiddle = i < kHalf ? kHalf - 1 - i : i - kHalf;
            const double x = double(fromMiddle) * step;
            const double piece =
                (profile.at(x) + 4 * profile.at(x + step / 2) + profile.at(x + step)) * step / 6;
            filter_[i + 1] = filter_[i] + piece;
            absolute_[i + 1] = absolute_[i] + std::abs(piece);
        }
    }

    double wholeFilter() const { return filter_.back(); }
    struct Place {
        double x, filter; ///< the integral up to there
    };
    /// Where the integral of the absolute value has this share of the whole.
    Place at(double share) const {
        const double wanted = share * absolute_.back();
        const auto above = std::upper_bound(absolute_.begin() + 1, absolute_.end() - 1, wanted);
        const auto i = size_t(above - absolute_.begin()) - 1;
        const double piece = absolute_[i + 1] - absolute_[i];
        const double part = piece > 0 ? std::clamp((wanted - absolute_[i]) / piece, 0.0, 1.0) : 0;
        return {(double(i) + part) * radius_ / kHalf - radius_,
                filter_[i] + part * (filter_[i + 1] - filter_[i])};
    }

  private:
    /// On each side: steps that are far shorter than the kernel's cells but in the filter's far
    /// ends, of which cells hold many.
    static constexpr size_t kHalf = size_t(1) << 16;

    double radius_;
    std::vector<double> filter_, absolute_;
};

} // namespace

uint32_t filterRows(PixelFilter filter) {
    return hasNegativeLobes(filter) ? gpu::FILTER_CELLS : 1;
}

std::vector<Row> filterTable(PixelFilter filter, const FilterShape& shape) {
    std::vector<gpu::FilterCell> cells;
    std::vector<Row> rows;
    if (!hasNegativeLobes(filter)) {
        appendRows(rows, gpu::FilterCell{});
        return rows;
    }
    const Integrals integrals(profileOf(filter, shape));
    Integrals::Place begin = integrals.at(0);
    for (uint32_t cell = 1; cell <= gpu::FILTER_CELLS; ++cell) {
        const Integrals::Place end = integrals.at(double(cell) / gpu::FILTER_CELLS);
        const double weight =
            gpu::FILTER_CELLS * (end.filter - begin.filter) / integrals.wholeFilter();
        cells.push_back({float(begin.x), float(end.x - begin.x), float(weight), 0});
        begin = end;
    }
    std::ranges::stable_partition(cells, [](const auto& cell) { return cell.weight > 0; });
    for (const gpu::FilterCell& cell : cells)
        appendRows(rows, cell);
    return rows;
}

} // namespace stromboli
