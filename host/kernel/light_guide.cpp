#include "host/kernel/light_guide.hpp"

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace stromboli {

namespace {

// --- Tries ---------------------------------------------------------------------------------------

/// Coordinates by which cells are cut: position, then normal.
constexpr uint32_t kAxes = 6;
using NotePlace = std::array<float, kAxes>;

/// A light sample to the environment.
struct Try {
    NotePlace place;
    uint32_t tile;
    double value; ///< what it brought
    bool isOfOdd; ///< LightNote::isOfOdd
};

/// Values above this quantile of those that are not 0 are taken for it, so that no cell is learnt
/// from a single sample.
constexpr double kLargestQuantile = 0.995;

std::vector<Try> triesOf(std::span<const LightNote> notes, const EnvironmentTable& table) {
    std::vector<Try> tries;
    std::vector<double> values;
    tries.reserve(notes.size());
    for (const LightNote& r : notes) {
        const glm::vec3 p = r.position, n = r.normal, sum = p + n + r.direction;
        const bool isFinite = std::isfinite(sum.x + sum.y + sum.z);
        if (!isFinite) continue;
        const double value = std::isfinite(r.value) && r.value > 0 ? r.value : 0;
        tries.push_back(
            {{p.x, p.y, p.z, n.x, n.y, n.z}, tileOf(table, r.direction), value, r.isOfOdd});
        if (value > 0) values.push_back(value);
    }
    if (values.empty()) return tries;
    const auto largest =
        values.begin() + std::ptrdiff_t(kLargestQuantile * double(values.size() - 1));
    std::ranges::nth_element(values, largest);
    for (Try& t : tries)
        t.value = std::min(t.value, *largest);
    return tries;
}

// --- Cells ---------------------------------------------------------------------------------------

constexpr uint32_t kHalvings = 2 * gpu::GUIDE_LEVELS;
static_assert(1u << kHalvings == gpu::GUIDE_CELLS);

struct Cut {
    uint32_t axis = 0;
    float at = 0;
};

/// A binary tree in which every cut leaves as many tries on both sides, but for equal coordinates.
/// Nodes are numbered level by level from 1; the children of i are 2 i and 2 i + 1.
struct Cells {
    std::vector<Cut> cuts = std::vector<Cut>(gpu::GUIDE_CELLS);
    std::vector<uint32_t> cellOf; ///< by try
};

/// How much of a cell's size a turn of its normals by 90 degrees counts for, in standard deviations
/// of all positions.
constexpr double kNormalWeight = 0.5;

struct Spread {
    std::array<double, kAxes> deviation{};

    Spread(std::span<const Try> tries, std::span<const uint32_t> some) {
        if (some.empty()) return;
        std::array<double, kAxes> mean{};
        for (const uint32_t i : some)
            for (uint32_t a = 0; a < kAxes; ++a)
                mean[a] += tries[i].place[a] / double(some.size());
        for (const uint32_t i : some)
            for (uint32_t a = 0; a < kAxes; ++a)
                deviation[a] += std::pow(tries[i].place[a] - mean[a], 2);
        for (double& d : deviation)
            d = std::sqrt(d / double(some.size()));
    }
};

Cells divide(std::span<const Try> tries) {
    Cells cells;
    cells.cellOf.resize(tries.size());
    std::vector<uint32_t> order(tries.size());
    std::iota(order.begin(), order.end(), 0u);
    const Spread all(tries, order);
    const double size = std::max({all.deviation[0], all.deviation[1], all.deviation[2]});
    using Run = std::span<uint32_t>;
    std::vector<Run> runs = {order};
    for (uint32_t level = 0; level < kHalvings; ++level) {
        std::vector<Run> halves(2 * runs.size());
        tbb::parallel_for(size_t(0), runs.size(), [&](size_t i) {
            const Run run = runs[i];
            Spread spread(tries, run);
            for (uint32_t a = 3; a < kAxes; ++a)
                spread.deviation[a] *= kNormalWeight * size;
            Cut& cut = cells.cuts[runs.size() + i];
            cut.axis =
                uint32_t(std::ranges::max_element(spread.deviation) - spread.deviation.begin());
            if (run.empty()) return;
            const auto coordinate = [&](uint32_t t) {
                return std::pair(tries[t].place[cut.axis], t);
            };
            const auto middle = run.begin() + std::ptrdiff_t((run.size() - 1) / 2);
            std::ranges::nth_element(run, middle, {}, coordinate);
            cut.at = tries[*middle].place[cut.axis];
            const auto above = std::partition(run.begin(), run.end(), [&](uint32_t t) {
                return !(tries[t].place[cut.axis] > cut.at);
            });
            halves[2 * i] = Run(run.begin(), above);
            halves[2 * i + 1] = Run(above, run.end());
        });
        runs = std::move(halves);
    }
    for (uint32_t cell = 0; cell < runs.size(); ++cell)
        for (const uint32_t t : runs[cell])
            cells.cellOf[t] = cell;
    return cells;
}

std::vector<gpu::GuideNode> nodesOf(const Cells& cells) {
    std::vector<gpu::GuideNode> nodes;
    for (uint32_t level = 0; level < gpu::GUIDE_LEVELS; ++level)
        for (uint32_t i = 1u << 2 * level; i < 2u << 2 * level; ++i) {
            const Cut &cut = cells.cuts[i], &below = cells.cuts[2 * size_t(i)],
                      &above = cells.cuts[2 * size_t(i) + 1];
            nodes.push_back(
                {cut.at, below.at, above.at, cut.axis | below.axis << 8 | above.axis << 16});
        }
    return nodes;
}

// --- Learning ------------------------------------------------------------------------------------

/// Numbers of a node, by tile.
struct Counts {
    std::vector<double> tries, squares; ///< how many, and the sum of their squared values
};

/// A node counts as much on what is known of its parent as on so many tries of its own.
constexpr double kTriesOfParent = 8;
/// Of a tile's counts to each of the four beside it, and this squared to those across.
constexpr double kShareBeside = 0.5;

std::vector<double> spreadOver(const std::vector<double>& x, uint32_t across) {
    const size_t down = x.size() / across;
    std::vector<double> rows(x.size()), all(x.size());
    for (size_t y = 0; y < down; ++y)
        for (size_t c = 0; c < across; ++c) {
            const size_t left = (c + across - 1) % across, right = (c + 1) % across;
            rows[y * across + c] =
                x[y * across + c] + kShareBeside * (x[y * across + left] + x[y * across + right]);
        }
    for (size_t y = 0; y < down; ++y)
        for (size_t c = 0; c < across; ++c) {
            double& sum = all[y * across + c] = rows[y * across + c];
            if (y > 0) sum += kShareBeside * rows[(y - 1) * across + c];
            if (y + 1 < down) sum += kShareBeside * rows[(y + 1) * across + c];
        }
    return all;
}

/// The second moments of light samples by tile, for each cell: those of its own tries and, as far
/// as these are few, of the cells about it. isLearnt: of each try.
template <class IsLearnt>
std::vector<std::vector<double>> secondMoments(std::span<const Try> tries, const Cells& cells,
                                               const EnvironmentTable& environment,
                                               IsLearnt isLearnt) {
    const uint32_t tiles = environment.light.tiles;
    std::vector<Counts> counts(2 * gpu::GUIDE_CELLS,
                               {std::vector<double>(tiles), std::vector<double>(tiles)});
    for (size_t i = 0; i < tries.size(); ++i) {
        if (!isLearnt(i)) continue;
        Counts& c = counts[gpu::GUIDE_CELLS + cells.cellOf[i]];
        c.tries[tries[i].tile] += 1;
        c.squares[tries[i].tile] += tries[i].value * tries[i].value;
    }
    for (size_t node = gpu::GUIDE_CELLS - 1; node > 0; --node)
        for (uint32_t t = 0; t < tiles; ++t) {
            counts[node].tries[t] = counts[2 * node].tries[t] + counts[2 * node + 1].tries[t];
            counts[node].squares[t] = counts[2 * node].squares[t] + counts[2 * node + 1].squares[t];
        }
    const double allTries = std::accumulate(counts[1].tries.begin(), counts[1].tries.end(), 0.0),
                 allSquares =
                     std::accumulate(counts[1].squares.begin(), counts[1].squares.end(), 0.0);
    std::vector<std::vector<double>> moments(2 * gpu::GUIDE_CELLS);
    moments[0].assign(tiles, allTries > 0 ? allSquares / allTries : 0);
    const auto learn = [&](size_t node) {
        const std::vector<double> n = spreadOver(counts[node].tries, environment.light.tilesAcross);
        std::vector<double> m = spreadOver(counts[node].squares, environment.light.tilesAcross);
        for (uint32_t t = 0; t < tiles; ++t)
            m[t] = (m[t] + kTriesOfParent * moments[node / 2][t]) / (n[t] + kTriesOfParent);
        moments[node] = std::move(m);
    };
    for (size_t first = 1; first < moments.size(); first *= 2)
        tbb::parallel_for(first, 2 * first, learn);
    moments.erase(moments.begin(), moments.begin() + gpu::GUIDE_CELLS);
    return moments;
}

/// The least second moment over all tiles has probabilities in proportion to those by weight times
/// the root of each tile's second moment.
std::vector<double> probabilities(const std::vector<double>& moments,
                                  const std::vector<double>& byWeight) {
    std::vector<double> p(moments.size());
    for (size_t t = 0; t < p.size(); ++t)
        p[t] = byWeight[t] * std::sqrt(moments[t]);
    const double sum = std::accumulate(p.begin(), p.end(), 0.0);
    for (size_t t = 0; t < p.size(); ++t)
        p[t] = sum > 0 ? std::lerp(p[t] / sum, byWeight[t], LightGuide::kUnlearned) : byWeight[t];
    return p;
}

/// TileRatios of all tiles. probabilities: with which the kernel picks them.
void appendRatios(std::vector<Row>& rows, const std::vector<double>& probabilities,
                  const EnvironmentTable& environment) {
    const uint32_t across = environment.light.tilesAcross, tiles = environment.light.tiles;
    std::vector<float> ratios(tiles);
    for (uint32_t t = 0; t < tiles; ++t) {
        const double byWeight = environment.tileProbability[t];
        ratios[t] = byWeight > 0 ? float(probabilities[t] / byWeight) : 0;
    }
    for (uint32_t t = 0; t < tiles; ++t) {
        const uint32_t right = t % across + 1 < across ? t + 1 : t + 1 - across;
        const uint32_t down = t + across < tiles ? across : 0;
        appendRows(rows, gpu::TileRatios{ratios[t], ratios[right], ratios[t + down],
                                         ratios[right + down]});
    }
    rows.resize(gpu::GUIDE_TABLE_ROWS);
}

/// LightGuide::gain: learnt from every other path, told by the rest.
double gainOf(std::span<const Try> tries, const Cells& cells, const EnvironmentTable& environment) {
    const std::vector<double>& byWeight = environment.tileProbability;
    std::vector<std::vector<double>> learnt =
        secondMoments(tries, cells, environment, [&](size_t i) { return !tries[i].isOfOdd; });
    for (std::vector<double>& cell : learnt)
        cell = probabilities(cell, byWeight);
    double before = 0, after = 0;
    for (size_t i = 0; i < tries.size(); ++i) {
        if (!tries[i].isOfOdd) continue;
        const double square = tries[i].value * tries[i].value, old = byWeight[tries[i].tile];
        if (!(old > 0)) continue;
        before += square;
        after += square * old / learnt[cells.cellOf[i]][tries[i].tile];
    }
    return after > 0 ? before / after : 1;
}

} // namespace

std::vector<Row> guideRows(std::span<const gpu::GuideNode> nodes,
                           std::span<const std::vector<double>> probabilities,
                           const EnvironmentTable& environment) {
    std::vector<Row> rows;
    for (const gpu::GuideNode& node : nodes)
        appendRows(rows, node);
    std::vector<std::vector<Row>> tables(probabilities.size());
    tbb::parallel_for(size_t(0), tables.size(), [&](size_t cell) {
        TileTable table = tileTable(probabilities[cell]);
        tables[cell] = std::move(table.rows);
        appendRatios(tables[cell], table.probabilities, environment);
    });
    for (const std::vector<Row>& table : tables)
        rows.insert(rows.end(), table.begin(), table.end());
    return rows;
}

LightGuide learnLightGuide(std::span<const LightNote> notes, const EnvironmentTable& environment) {
    LightGuide guide;
    const std::vector<Try> tries = triesOf(notes, environment);
    if (tries.size() < LightGuide::kLeastNotes) return guide;
    const Cells cells = divide(tries);
    guide.gain = gainOf(tries, cells, environment);
    std::vector<std::vector<double>> learnt =
        secondMoments(tries, cells, environment, [](size_t) { return true; });
    for (std::vector<double>& cell : learnt)
        cell = probabilities(cell, environment.tileProbability);
    guide.rows = guideRows(nodesOf(cells), learnt, environment);
    return guide;
}

} // namespace stromboli
