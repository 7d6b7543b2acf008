#pragma once

#include "host/kernel/light_tree.hpp"
#include "host/kernel/rows.hpp"
#include "host/render/estimator.hpp"
#include "shaders/shared/light_types.h"

#include <span>
#include <vector>

namespace stromboli {

/// The irradiance that a light brings to a surface across the scene, both sides of it counted: by
/// what an alias table picks lights. radius: how far apart lights and surfaces are, more or less.
double irradianceAcross(const LightBounds& bounds, double radius);

/// Lights of which one is picked, by a tree or by an alias table, whichever is better in a picture.
struct WeighedLights {
    std::vector<gpu::LightEntry> entries;  ///< by number, with trails, without probabilities
    std::vector<LightBounds> bounds;       ///< by number
    LightTree tree;                        ///< over them, in the order of their numbers
    double radius = 1;                     ///< of irradianceAcross()
    LightChoice plain = LightChoice::Tree; ///< Tree or Power: without factors
};

/// LightTable::table, by which light samples pick lights. choice: Tree or Power. factors: how many
/// times as much each light weighs, by number, positive; empty: none has another weight. Light
/// samples know the probabilities that follow, so that all factors leave pictures without bias.
std::vector<Row> tableOf(const WeighedLights& lights, LightChoice choice,
                         std::span<const double> factors = {});

} // namespace stromboli
