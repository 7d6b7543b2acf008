// The tables by which the kernel samples pixel filters that are negative in places.
#include "host/kernel/sampling_tables.hpp"

#include "shaders/shared/interface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli {
namespace {

std::vector<gpu::FilterCell> cellsOf(PixelFilter filter, const FilterShape& shape = {}) {
    const std::vector<Row> rows = filterTable(filter, shape);
    std::vector<gpu::FilterCell> cells;
    for (size_t i = 0; i < rows.size(); ++i)
        cells.push_back(structureAt<gpu::FilterCell>(rows, i));
    return cells;
}

/// What the table makes of the filter's integral up to x.
double tableBelow(const std::vector<gpu::FilterCell>& cells, double x) {
    double sum = 0;
    for (const gpu::FilterCell& cell : cells)
        sum += cell.weight * std::clamp((x - cell.begin) / std::max(cell.width, 1e-12f), 0.0, 1.0);
    return sum / double(cells.size());
}

/// The integral of Catmull and Rom's filter from its left end.
double catmullRomBelow(double x) {
    const auto outer = [](double t) { return ((-t / 8 + 5.0 / 6) * t - 2) * t * t + 2 * t; };
    const auto inner = [](double t) { return (t * 3 / 8 - 5.0 / 6) * t * t * t + t; };
    const double size = std::min(std::abs(x), 2.0);
    const double half =
        size < 1 ? inner(size) : inner(1) + (outer(size) - outer(1)); // from the middle
    return 0.5 + (x < 0 ? -half : half);
}

TEST(FilterTable, IsTheFilter) {
    const std::vector<gpu::FilterCell> cells = cellsOf(PixelFilter::CatmullRom);
    ASSERT_EQ(cells.size(), gpu::FILTER_CELLS);
    // The filter's absolute value has 7/6 of its integral; the table errs by half a cell at most.
    const double largest = 0.5 * 7 / 6 / gpu::FILTER_CELLS;
    for (double x = -2.1; x < 2.1; x += 0.0137)
        EXPECT_NEAR(tableBelow(cells, x), catmullRomBelow(x), largest) << x;
}

TEST(FilterTable, CellsFollowEachOtherAndWeighOneOnTheMean) {
    const std::pair<PixelFilter, FilterShape> filters[] = {
        {PixelFilter::Mitchell, {}},           {PixelFilter::Mitchell, {.b = 0, .c = 1}},
        {PixelFilter::CatmullRom, {}},         {PixelFilter::Lanczos, {}},
        {PixelFilter::Lanczos, {.lobes = 64}},
    };
    for (const auto& [filter, shape] : filters) {
        std::vector<gpu::FilterCell> cells = cellsOf(filter, shape);
        const auto isPositive = [](const gpu::FilterCell& cell) { return cell.weight > 0; };
        EXPECT_TRUE(std::ranges::is_partitioned(cells, isPositive));
        std::ranges::sort(cells, {}, &gpu::FilterCell::begin);
        double sum = 0, end = cells.front().begin;
        EXPECT_EQ(end, filter == PixelFilter::Lanczos ? -double(shape.lobes) : -2.0);
        for (const gpu::FilterCell& cell : cells) {
            EXPECT_NEAR(cell.begin, end, 1e-5);
            EXPECT_GE(cell.width, 0);
            end = double(cell.begin) + cell.width;
            sum += cell.weight;
        }
        EXPECT_NEAR(end, filter == PixelFilter::Lanczos ? shape.lobes : 2.0, 1e-5);
        EXPECT_NEAR(sum / double(cells.size()), 1, 1e-6);
    }
}

TEST(FilterTable, OthersHaveNone) {
    for (const PixelFilter filter :
         {PixelFilter::Box, PixelFilter::Gaussian, PixelFilter::BlackmanHarris, PixelFilter::Tent})
        EXPECT_EQ(filterTable(filter, {}).size(), 1u);
}

} // namespace
} // namespace stromboli
