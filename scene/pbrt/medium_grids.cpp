#include "scene/pbrt/medium_grids.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/pbrt/colors.hpp"
#include "scene/pbrt/nanovdb.hpp"
#include "scene/pbrt/usable_value.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace stromboli::pbrt {
namespace {

constexpr uint64_t kMostValues = uint64_t(1) << 31;

/// The grid's place, without values.
template <class Value>
Grid<Value> emptyGrid(const Parameters& p, const glm::dmat4& worldFromMedium,
                      const glm::uvec3& cells) {
    Grid<Value> grid;
    grid.size = cells;
    const glm::dvec3 low = p.vector("p0").value_or(glm::dvec3(0));
    const glm::dvec3 high = p.vector("p1").value_or(glm::dvec3(1));
    const glm::dvec3 size = high - low;
    if (size.x == 0 || size.y == 0 || size.z == 0) p.place().fail("has a box without a volume");
    const glm::dmat4 identity(1.0);
    grid.setWorld(worldFromMedium * glm::translate(identity, low) * glm::scale(identity, size));
    return grid;
}

/// It has as many cells as the file states.
template <class Value>
Grid<Value> emptyGrid(const Parameters& p, const glm::dmat4& worldFromMedium) {
    glm::uvec3 cells(1);
    constexpr const char* kSizes[] = {"nx", "ny", "nz"};
    for (int axis = 0; axis < 3; ++axis) {
        const int64_t size = p.integer(kSizes[axis]).value_or(1);
        if (size < 1 || size > 1 << 16)
            p.place().fail(
                fmt::format("has '{}' {}, expected from 1 to 65536", kSizes[axis], size));
        cells[axis] = uint32_t(size);
    }
    return emptyGrid<Value>(p, worldFromMedium, cells);
}

/// Fails where there is no value for each cell. found: values of a cell's `each` numbers.
void expectValues(const Parameters& p, const char* name, size_t found, const glm::uvec3& size,
                  size_t each) {
    const uint64_t count = uint64_t(size.x) * size.y * size.z;
    if (count > kMostValues || found != count * each)
        p.place().fail(
            fmt::format("has {} values of '{}', expected {}", found, name, count * each));
}

/// Colours that a parameter lists; negative channels count as 0.
ColorGrid colorsOf(const Parameters& p, const char* name, const glm::dmat4& worldFromMedium) {
    auto grid = emptyGrid<glm::vec3>(p, worldFromMedium);
    const std::vector<double> numbers = p.numbers(name);
    expectValues(p, name, numbers.size(), grid.size, 3);
    for (size_t i = 0; i < numbers.size(); i += 3)
        grid.values.emplace_back(usable(numbers[i]), usable(numbers[i + 1]),
                                 usable(numbers[i + 2]));
    return grid;
}

} // namespace

DensityGrid emptyDensity(const Parameters& p, const glm::dmat4& worldFromMedium,
                         const glm::uvec3& cells) {
    return emptyGrid<float>(p, worldFromMedium, cells);
}

DensityGrid gridOf(const Parameters& p, const char* name, const glm::dmat4& worldFromMedium) {
    auto grid = emptyGrid<float>(p, worldFromMedium);
    const std::vector<double> values = p.numbers(name);
    expectValues(p, name, values.size(), grid.size, 1);
    for (const double value : values)
        grid.values.push_back(usable(value));
    return grid;
}

/// Of the extinction, by channel.
glm::dvec3 meanShare(const ColorGrid& scattering, const ColorGrid& extinction) {
    glm::dvec3 scattered(0.0), all(0.0);
    for (const glm::vec3& value : scattering.values)
        scattered += glm::dvec3(value);
    for (const glm::vec3& value : extinction.values)
        all += glm::dvec3(value);
    const double scale = double(extinction.values.size()) / double(scattering.values.size());
    glm::dvec3 share(0.0);
    for (int c = 0; c < 3; ++c)
        if (all[c] > 0) share[c] = std::min(scattered[c] * scale / all[c], 1.0);
    return share;
}

void readColoredGrid(const Parameters& p, double scale, const glm::dmat4& worldFromMedium,
                     Medium& medium) {
    if (!p.has("sigma_a") && !p.has("sigma_s"))
        p.place().fail("has no 'sigma_a' and no 'sigma_s', expected one of them at least");
    // One that is not stated is 1 everywhere.
    const bool hasAbsorption = p.has("sigma_a"), hasScattering = p.has("sigma_s");
    ColorGrid extinction = colorsOf(p, hasAbsorption ? "sigma_a" : "sigma_s", worldFromMedium);
    ColorGrid scattering = extinction;
    if (hasScattering)
        scattering = colorsOf(p, "sigma_s", worldFromMedium);
    else
        std::ranges::fill(scattering.values, glm::vec3(1));
    for (size_t i = 0; i < extinction.values.size(); ++i)
        extinction.values[i] += hasAbsorption ? scattering.values[i] : glm::vec3(1);
    // Their sum is the factor of both grids. What is told of the medium as a whole, as its albedo,
    // is the mean share.
    const glm::dvec3 share = meanShare(scattering, extinction);
    medium.scattering = glm::vec3(scale * share);
    medium.absorption = glm::vec3(float(scale)) - medium.scattering;
    medium.colors.extinction = std::move(extinction);
    medium.colors.scattering = std::move(scattering);
    medium.colors.scatteringIsFactor = true;
    const double brightness = kUnscaledLight * p.number("Lescale", 1, 0, 1e30);
    if (!p.has("Le")) return;
    ColorGrid source = colorsOf(p, "Le", worldFromMedium);
    for (glm::vec3& color : source.values)
        color = glm::vec3(usable(color.x * brightness), usable(color.y * brightness),
                          usable(color.z * brightness));
    medium.colors.source = std::move(source);
}

void readGridEmission(const Context& context, const Parameters& p, Medium& medium) {
    const std::optional<glm::dvec3> color = colorOf(context, p, "Le", ColorOf::Light);
    const double offset =
        p.number("temperatureoffset", p.number("temperaturecutoff", 0, -1e9, 1e9), -1e9, 1e9);
    const double perKelvin = p.number("temperaturescale", 1, 0, 1e9);
    const DensityGrid& density = *medium.density;
    const size_t count = density.values.size();
    std::vector<double> scales{1}, temperatures;
    if (p.has("Lescale")) scales = p.numbers("Lescale");
    if (scales.size() != 1) expectValues(p, "Lescale", scales.size(), density.size, 1);
    if (p.has("temperature")) {
        temperatures = p.numbers("temperature");
        expectValues(p, "temperature", temperatures.size(), density.size, 1);
    }
    const auto scaleOf = [&](size_t i) { return scales.size() == 1 ? scales[0] : scales[i]; };
    if (temperatures.empty() && scales.size() == 1) {
        if (color)
            medium.emission = glm::dvec3(medium.absorption) * *color * double(usable(scales[0]));
        return;
    }
    ColorGrid source;
    source.size = density.size;
    source.toUnit = density.toUnit;
    double hottest = 0;
    for (size_t i = 0; i < count; ++i) {
        const float scale = usable(scaleOf(i) * (temperatures.empty() ? 1 : kUnscaledLight));
        const double kelvins =
            temperatures.empty() ? 0 : std::max((temperatures[i] - offset) * perKelvin, 0.0);
        hottest = std::max(hottest, double(usable(kelvins)));
        source.values.push_back(temperatures.empty()
                                    ? scale * glm::vec3(color.value_or(glm::dvec3(0)))
                                    : glm::vec3(scale, usable(kelvins), 0));
    }
    if (!temperatures.empty()) {
        if (color)
            p.replaceParameter("Le", build::Shortfall::Parameter, "is stated beside 'temperature'");
        medium.colors.glow = glowTable(std::min(hottest, 1e6));
    }
    medium.colors.source = std::move(source);
}

namespace {

/// A box of more cells has cells of several voxels: half a gigabyte.
constexpr uint64_t kMostCells = uint64_t(1) << 27;

/// At the middles of the density's cells; both grids are in the file's own space.
ColorGrid glowOf(const std::string& file, const DensityGrid& density,
                 const DensityGrid& temperature, float scale, double offset, double perKelvin) {
    ColorGrid source;
    const uint64_t cells = density.values.size();
    build::requireMemory(file, (cells + temperature.values.size()) * sizeof(float) +
                                   cells * sizeof(glm::vec3));
    source.values.reserve(cells);
    source.size = density.size;
    source.toUnit = density.toUnit;
    glm::dmat4 toUnit(1.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            toUnit[column][row] = density.toUnit[size_t(row)][column];
    const glm::dmat4 fromUnit = glm::inverse(toUnit);
    for (uint32_t z = 0; z < density.size.z; ++z)
        for (uint32_t y = 0; y < density.size.y; ++y)
            for (uint32_t x = 0; x < density.size.x; ++x) {
                const glm::dvec3 middle = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(density.size);
                const glm::dvec3 inFile(fromUnit * glm::dvec4(middle, 1));
                const double kelvins =
                    (temperature.at(temperature.place(inFile)) - offset) * perKelvin;
                source.values.emplace_back(scale, usable(kelvins), 0);
            }
    return source;
}

/// The grid of that name, or nothing.
std::optional<DensityGrid> nanoGrid(const Context& context, const Parameters& p,
                                    const std::string& bytes, const std::string& file,
                                    const std::string& name) {
    std::optional<NanoGrid> read = readNanoGrid(bytes, file, name, kMostCells);
    if (!read) return std::nullopt;
    if (read->voxelsOfCell > 1)
        context.report().replace(p.place(), build::Shortfall::Model,
                                 fmt::format("has more than {} voxels of {}: cells of {} on a side",
                                             kMostCells, name, read->voxelsOfCell));
    return std::move(read->grid);
}

} // namespace

void readNanoMedium(const Context& context, const Parameters& p, const glm::dmat4& worldFromMedium,
                    Medium& medium) {
    const std::string file =
        context.files.find(p.place(), p.text("filename").value_or("")).string();
    const std::string bytes = build::readFile(file);
    std::optional<DensityGrid> density = nanoGrid(context, p, bytes, file, "density");
    if (!density) throw SceneError(file, 0, "", "has no grid 'density'");
    const double scale = p.number("Lescale", p.number("LeScale", 1, 0, 1e30), 0, 1e30);
    const double offset =
        p.number("temperatureoffset", p.number("temperaturecutoff", 0, -1e9, 1e9), -1e9, 1e9);
    const double perKelvin = p.number("temperaturescale", 1, 0, 1e9);
    if (scale > 0)
        if (const auto temperature = nanoGrid(context, p, bytes, file, "temperature")) {
            ColorGrid source = glowOf(file, *density, *temperature, usable(kUnscaledLight * scale),
                                      offset, perKelvin);
            float hottest = 0;
            for (const glm::vec3& value : source.values)
                hottest = std::max(hottest, value.y);
            if (hottest > 0) {
                medium.colors.glow = glowTable(std::min(double(hottest), 1e6));
                medium.colors.source = std::move(source);
            }
        }
    const glm::dmat4 mediumFromWorld = glm::inverse(worldFromMedium);
    const auto place = [&](std::array<glm::dvec4, 3>& toUnit) {
        for (glm::dvec4& row : toUnit) {
            const glm::dvec4 inFile = row;
            for (int column = 0; column < 4; ++column)
                row[column] = glm::dot(inFile, mediumFromWorld[column]);
        }
    };
    place(density->toUnit);
    if (medium.colors.source) place(medium.colors.source->toUnit);
    medium.density = std::move(*density);
}

void strengthen(Medium& medium, double factor) {
    medium.emission *= float(factor);
    if (!medium.colors.source) return;
    const bool isGlow = medium.colors.glow.has_value(); // by the temperature in the second channel
    for (glm::vec3& value : medium.colors.source->values)
        value = float(factor) * (isGlow ? glm::vec3(value.x, value.y / float(factor), 0) : value);
}

GlowTable glowTable(double hottest) {
    constexpr int kSteps = 256;
    GlowTable table;
    // Colder ones send out less than 1e-15 of what they could be seen by.
    table.coldest = 500;
    table.hottest = float(std::max(hottest, 1000.0));
    const double first = 1 / double(table.coldest), last = 1 / double(table.hottest);
    for (int i = 0; i < kSteps; ++i) {
        const double kelvins = 1 / (first + (last - first) * i / (kSteps - 1));
        const glm::dvec3 color = glm::max(blackbodyOfPeak(kelvins), 0.0);
        const double y = std::max(luminance(color), 1e-300);
        table.values.emplace_back(glm::vec3(color / y), float(std::log(y)));
    }
    return table;
}

} // namespace stromboli::pbrt
