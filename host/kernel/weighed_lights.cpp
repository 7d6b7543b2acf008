#include "host/kernel/weighed_lights.hpp"

#include "host/kernel/sampling_tables.hpp"

#include <array>
#include <bit>
#include <numeric>

namespace stromboli {
namespace {

double factorOf(std::span<const double> factors, size_t light) {
    return factors.empty() ? 1 : factors[light];
}

std::vector<Row> treeTable(const WeighedLights& lights, std::span<const double> factors) {
    std::vector<Row> table;
    for (const gpu::LightEntry& entry : lights.entries)
        appendRows(table, entry);
    std::vector<gpu::LightNode> nodes = lights.tree.nodes;
    if (!factors.empty()) setPowers(nodes, lights.tree.lightsInGroup, lights.bounds, factors);
    // All first rows, then all second ones, which few scenes read.
    for (const size_t part : {0, 1})
        for (const gpu::LightNode& node : nodes)
            table.push_back(std::bit_cast<std::array<Row, 2>>(node)[part]);
    return table;
}

std::vector<Row> aliasTable(const WeighedLights& lights, const HowLightsArePicked& how) {
    std::vector<gpu::LightEntry> entries = lights.entries;
    std::vector<double> weights;
    double plain = 0;
    for (size_t i = 0; i < lights.bounds.size(); ++i) {
        const double weight = irradianceAcross(lights.bounds[i], lights.radius);
        weights.push_back(weight * factorOf(how.factors, i));
        plain += weight;
    }
    if (how.none > 0) {
        entries.push_back(entries.front());
        weights.push_back(how.none * plain);
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<Row> table;
    for (size_t i = 0; i < entries.size(); ++i) {
        const bool isLight = i < lights.entries.size();
        entries[i].probability = isLight ? float(weights[i] / sum) : 0;
        appendRows(table, entries[i]);
    }
    for (const AliasColumn& column : buildAliasTable(weights))
        appendRows(table, gpu::AliasColumn{float(column.threshold), column.alias, 0, 0});
    return table;
}

} // namespace

double irradianceAcross(const LightBounds& bounds, double radius) {
    const double falloff = bounds.group == gpu::LIGHT_GROUP_NEAR ? radius * radius : 1;
    return bounds.power * (bounds.bothSides ? 2 : 1) / falloff;
}

std::vector<Row> tableOf(const WeighedLights& lights, const HowLightsArePicked& how) {
    return how.choice == LightChoice::Tree ? treeTable(lights, how.factors)
                                           : aliasTable(lights, how);
}

} // namespace stromboli
