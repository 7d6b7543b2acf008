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

/// How a light sample picks one of several lights. It knows the probabilities that follow, so that
/// any leave pictures without bias.
struct HowLightsArePicked {
    LightChoice choice = LightChoice::Tree; ///< Tree or Power
    /// How many times as much each light weighs, by number, positive; empty: none has another
    /// weight.
    std::vector<double> factors;
    /// Power: how much it weighs to take no light sample at all, by what all lights weigh without
    /// factors.
    double none = 0;
};

/// LightTable::table, by which light samples pick lights: with a LightEntry more, of probability 0,
/// where they may take none.
std::vector<Row> tableOf(const WeighedLights& lights, const HowLightsArePicked& how);

} // namespace stromboli
