#include "host/kernel/sampling_tables.hpp"

#include "host/core/color.hpp"
#include "shaders/shared/interface.h"

#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace stromboli {

// --- Alias tables --------------------------------------------------------------------------------

namespace {

/// Calls set(index, column) for each index of the alias table, in any order. sum: of the weights.
template <class Set>
void makeColumns(std::span<const double> weights, double sum, Set set) {
    const size_t n = weights.size();
    std::vector<double> scaled(n);
    // Two stacks in one array: what is below 1 from its beginning, all others from its end.
    std::vector<uint32_t> stacks(n);
    size_t small = 0, large = n;
    for (uint32_t i = 0; i < n; ++i) {
        scaled[i] = weights[i] * double(n) / sum;
        const bool isSmall = scaled[i] < 1;
        stacks[small] = stacks[large - 1] = i; // one of them stays: no branch is guessed wrongly
        small += isSmall;
        large -= !isSmall;
    }
    while (small > 0 && large < n) {
        const uint32_t s = stacks[--small], l = stacks[large];
        set(s, AliasColumn{scaled[s], l});
        scaled[l] -= 1 - scaled[s];
        if (scaled[l] < 1) {
            ++large;
            stacks[small++] = l;
        }
    }
    // What is left is 1 but for rounding. An index of weight 0 cannot be left here alone: its
    // column was filled while a larger one was at hand.
    while (small > 0) {
        const uint32_t i = stacks[--small];
        if (weights[i] > 0) {
            set(i, AliasColumn{1.0, i});
        } else {
            const auto heaviest = std::ranges::max_element(weights) - weights.begin();
            set(i, AliasColumn{0.0, uint32_t(heaviest)});
        }
    }
    for (; large < n; ++large)
        set(stacks[large], AliasColumn{1.0, stacks[large]});
}

} // namespace

std::vector<AliasColumn> buildAliasTable(std::span<const double> weights) {
    std::vector<AliasColumn> table(weights.size());
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    makeColumns(weights, sum, [&](uint32_t i, const AliasColumn& column) { table[i] = column; });
    return table;
}

// --- Environments --------------------------------------------------------------------------------

namespace {

constexpr uint32_t kMostMantissa = (1u << gpu::ENVIRONMENT_MANTISSA_BITS) - 1;
/// Exponents whose scale, 2^(exponent - bias), is a normal float.
constexpr int kLeastExponent = int(gpu::ENVIRONMENT_EXPONENT_BIAS) - 126, kMostExponent = 255;

/// 2^(exponent - bias), exponent being kLeastExponent to kMostExponent.
float scaleOf(int exponent) {
    return std::bit_cast<float>(uint32_t(exponent + 127 - int(gpu::ENVIRONMENT_EXPONENT_BIAS))
                                << 23);
}

} // namespace

void encodeRadiance(const glm::vec3& radiance, gpu::EnvironmentTexel& texel) {
    const float largest = std::max({radiance.x, radiance.y, radiance.z});
    // largest < 2^power; for what is no normal float a power that is clamped like its own.
    const int power = int(std::bit_cast<uint32_t>(largest) >> 23) - 126;
    const int exponent = std::clamp(power - int(gpu::ENVIRONMENT_MANTISSA_BITS) +
                                        int(gpu::ENVIRONMENT_EXPONENT_BIAS),
                                    kLeastExponent, kMostExponent);
    // The reciprocal of a power of two is one, so that the product is the quotient.
    static_assert(2 * int(gpu::ENVIRONMENT_EXPONENT_BIAS) - kMostExponent >= kLeastExponent);
    const float reciprocal = scaleOf(2 * int(gpu::ENVIRONMENT_EXPONENT_BIAS) - exponent);
    uint32_t mantissa[3];
    for (int c = 0; c < 3; ++c)
        mantissa[c] = std::min(uint32_t(radiance[c] * reciprocal + 0.5f), kMostMantissa);
    texel.low = mantissa[0] | mantissa[1] << 18;
    texel.high = mantissa[1] >> 14 | mantissa[2] << 4 | uint32_t(exponent) << 22;
}

glm::vec3 decodeRadiance(const gpu::EnvironmentTexel& texel) {
    const uint32_t mantissa[3] = {texel.low, texel.low >> 18 | texel.high << 14, texel.high >> 4};
    const float scale = scaleOf(int(texel.high >> 22 & 0xFF));
    glm::vec3 radiance;
    for (int c = 0; c < 3; ++c)
        radiance[c] = float(mantissa[c] & kMostMantissa) * scale;
    return radiance;
}

namespace {

/// How the texels of an environment are divided into tiles (shaders/shared/light_types.h).
struct Tiles {
    uint32_t width, height, shift = 0, across, down;

    Tiles(uint32_t w, uint32_t h) : width(w), height(h) {
        const auto tilesOf = [&](uint32_t texels) { return (texels + (1u << shift) - 1) >> shift; };
        while (tilesOf(w) > gpu::ENVIRONMENT_TILES_ACROSS ||
               tilesOf(h) > gpu::ENVIRONMENT_TILES_DOWN)
            ++shift;
        across = tilesOf(w);
        down = tilesOf(h);
    }

    uint32_t count() const { return across * down; }
    /// Calls f(texel, its row) for the texels of a tile, in order.
    template <class F>
    void forEachTexel(uint32_t tile, F f) const {
        const uint32_t x0 = tile % across << shift, y0 = tile / across << shift;
        const uint32_t x1 = std::min(x0 + (1u << shift), width),
                       y1 = std::min(y0 + (1u << shift), height);
        for (uint32_t y = y0; y < y1; ++y)
            for (uint32_t x = x0; x < x1; ++x)
                f(size_t(y) * width + x, y);
    }
};

// The kernel chooses by thresholds in steps of 2^-31 (shaders/lights/environment.glsl).

/// As the kernel reads it: no positive threshold becomes 0.
float steppedThreshold(double threshold) {
    return threshold > 0 ? std::max(float(threshold), 0x1p-31f) : 0;
}
/// The share of a column that a threshold of the kernel chooses.
double chosenShare(double threshold) {
    return std::floor(threshold * 0x1p31) * 0x1p-31;
}

struct TileSums {
    double light = 0;   ///< luminances times sines: the weights of texels
    double squares = 0; ///< squared luminances times sines
};

/// The texels of a tile as columns of its alias table. sines: of the polar angle, by row, times the
/// part that there is of the row.
TileSums packTile(const Environment& environment, const Tiles& tiles, uint32_t tile,
                  std::span<const double> sines, std::span<Row> texels) {
    std::vector<double> weights;
    std::vector<uint32_t> places;
    weights.reserve(size_t(1) << 2 * tiles.shift);
    places.reserve(size_t(1) << 2 * tiles.shift);
    TileSums sums;
    tiles.forEachTexel(tile, [&](size_t place, uint32_t y) {
        gpu::EnvironmentTexel texel{};
        encodeRadiance(environment.radiance[place], texel);
        texels[place] = std::bit_cast<Row>(texel);
        const double light = luminance(decodeRadiance(texel)), sine = sines[y];
        weights.push_back(light * sine);
        places.push_back(uint32_t(place));
        sums.light += weights.back();
        sums.squares += light * light * sine;
    });
    if (!(sums.light > 0)) return {}; // no sample comes here
    makeColumns(weights, sums.light, [&](uint32_t i, const AliasColumn& column) {
        auto texel = std::bit_cast<gpu::EnvironmentTexel>(texels[places[i]]);
        texel.threshold = steppedThreshold(column.threshold);
        texel.alias = places[column.alias];
        texels[places[i]] = std::bit_cast<Row>(texel);
    });
    return sums;
}

} // namespace

TileTable tileTable(std::span<const double> probabilities) {
    std::vector<AliasColumn> columns = buildAliasTable(probabilities);
    const size_t n = columns.size();
    TileTable table;
    table.probabilities.resize(n);
    for (size_t i = 0; i < n; ++i) {
        const double own =
            chosenShare(columns[i].threshold = steppedThreshold(columns[i].threshold));
        table.probabilities[i] += own / double(n);
        table.probabilities[columns[i].alias] += (1 - own) / double(n);
    }
    columns.resize(gpu::ENVIRONMENT_TILES);
    for (size_t i = 0; i < columns.size(); i += 2)
        appendRows(table.rows,
                   gpu::TileColumns{float(columns[i].threshold), columns[i].alias,
                                    float(columns[i + 1].threshold), columns[i + 1].alias});
    return table;
}

EnvironmentTable packEnvironment(const Environment& environment) {
    const uint32_t width = environment.width, height = environment.height;
    const size_t count = size_t(width) * height;
    const Tiles tiles(width, height);
    EnvironmentTable table;
    std::vector<double> weights(tiles.count()), squares(tiles.count()), sines;
    table.rows = environment.rows();
    for (uint32_t y = 0; y < height; ++y)
        sines.push_back(table.rows.sineOf(y) * table.rows.partOf(y));
    const auto rows = std::make_shared<RowPages>(gpu::ENVIRONMENT_COLUMN_ROWS + count);
    const std::span<Row> texels = std::span(*rows).subspan(gpu::ENVIRONMENT_COLUMN_ROWS);
    tbb::parallel_for(0u, tiles.count(), [&](uint32_t tile) {
        const TileSums sums = packTile(environment, tiles, tile, sines, texels);
        weights[tile] = sums.light;
        squares[tile] = sums.squares;
    });
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) return {};
    for (double& weight : weights)
        weight /= sum;
    table.tileProbability = weights;
    std::ranges::copy(tileTable(weights).rows, rows->begin());
    table.texels = rows;
    // A texel's solid angle is 2 pi / width times pi / span times its sine.
    const double texelsPerAngle =
        width * table.rows.span() / (2 * glm::pi<double>() * glm::pi<double>());
    table.light.width = width;
    table.light.height = height;
    table.light.density = float(texelsPerAngle / sum);
    table.light.tileShift = tiles.shift;
    table.light.tilesAcross = tiles.across;
    table.light.tiles = tiles.count();
    table.luminance = sum / texelsPerAngle * environment.strength;
    const double all = width * std::accumulate(sines.begin(), sines.end(), 0.0);
    table.unevenness = std::accumulate(squares.begin(), squares.end(), 0.0) * all / (sum * sum);
    return turned(std::move(table), environment.rotation);
}

EnvironmentTable turned(EnvironmentTable table, float rotation) {
    table.light.cosRotation = std::cos(rotation);
    table.light.sinRotation = std::sin(rotation);
    return table;
}

uint32_t tileOf(const EnvironmentTable& table, const glm::vec3& direction) {
    const gpu::EnvironmentLight& light = table.light;
    const glm::vec3 d(light.cosRotation * direction.x - light.sinRotation * direction.z,
                      direction.y,
                      light.cosRotation * direction.z + light.sinRotation * direction.x);
    const double u = std::atan2(double(d.x), -double(d.z)) / (2 * glm::pi<double>()) + 0.5;
    const double polar = std::atan2(std::hypot(double(d.x), double(d.z)), double(d.y));
    const auto column = std::min(uint32_t(u * light.width), light.width - 1);
    const auto row = std::min(uint32_t(table.rows.placeAt(polar)), light.height - 1);
    return (row >> light.tileShift) * light.tilesAcross + (column >> light.tileShift);
}

// --- Pixel filters -------------------------------------------------------------------------------

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
