#pragma once

#include "host/kernel/rows.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "host/kernel/weighed_lights.hpp"
#include "host/render/estimator.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/light_types.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- The table of lights -------------------------------------------------------------------------

/// Which lights are sampled, and how one of them is picked.
struct LightSelection {
    LightChoice choice = LightChoice::Automatic;
    /// Others are left to rays.
    bool deltaLightsOnly = false;
    /// Ambient light is left to bounces where there are other lights.
    bool ambientToBounces = false;
    /// Emissive geometry is sampled.
    bool emitters = true;
    /// Lights of the file that bring no light are lights too, and each of several ambient lights is
    /// one by itself.
    bool everyLightOfTheFile = false;
    /// Lamps in clear glass are left to bounces (lampsInGlass()), which find all light.
    bool leavesLampsInGlass = false;
};

LightSelection lightSelection(const Estimator& settings);

/// The lights of a scene in the arrays that the kernel reads (shaders/shared/light_types.h).
struct LightTable {
    std::vector<Row> lights; ///< the parameters: ambient lights first
    std::vector<Row> table;  ///< LightEntry rows, then AliasColumn or LightNode rows
    /// The table of the environment's picture; null if there is none, or a black one.
    std::shared_ptr<const EnvironmentTable> environment;
    uint32_t count = 0;   ///< lights that are sampled
    uint32_t entries = 0; ///< rows of LightEntry: of these, and of none where samples may take none
    uint32_t areaCount = 0; ///< those of them that rays can meet; LightChoice::Each: the first
    /// The scene has a sky, sampled or not: ambient light or an environment.
    bool hasAmbient = false;
    bool hasBackdrop = false;               ///< the camera sees the sky
    bool ambientLeftToBounces = false;      ///< by LightSelection::ambientToBounces
    std::vector<uint32_t> leftToBounces;    ///< primitives of lamps that are not sampled
    uint32_t sampledKinds = 0;              ///< bit n: a light of LIGHT_ kind n is sampled
    uint32_t ambientNumber = gpu::NO_LIGHT; ///< of the sky, where it is sampled
    uint32_t groups = 0;                    ///< LightTree::groups
    std::array<uint32_t, gpu::LIGHT_GROUP_COUNT> lightsInGroup{}; ///< LightTree::lightsInGroup
    uint32_t levels = 0;                                          ///< LightTree::levels
    LightChoice choice = LightChoice::Tree; ///< what the selection came to; not Automatic
    /// By primitive of the scene (triangles, then spheres): its light's number, or NO_LIGHT; empty
    /// where no primitive is a sampled light.
    std::vector<uint32_t> numberOf;
    /// Of few lights of which one is picked, by a choice that was left to us: what pickBy() writes
    /// the table from.
    std::optional<WeighedLights> weighed;
    bool isPickedByArrival = false; ///< it has factors

    /// EnvironmentTexel rows; empty: there is no picture.
    std::span<const Row> environmentRows() const {
        return environment ? std::span(*environment->texels) : std::span<const Row>();
    }
};

/// placeOf: by primitive of the scene, what a LightEntry is to name an emissive triangle by.
/// pictures: by light of the scene, the first row of its picture's TextureUse; empty: none has one.
/// environment: of the scene's environment, where it was packed before, with any rotation.
/// isLeft: by primitive, whether it is a lamp that is left to bounces; empty: none is.
LightTable packLights(const Scene& scene, std::span<const uint32_t> placeOf,
                      const LightSelection& selection, std::span<const uint32_t> pictures = {},
                      std::shared_ptr<const EnvironmentTable> environment = {},
                      const std::vector<bool>& isLeft = {});

/// Has light samples pick lights by another tree or alias table (tableOf()). Only of a table with
/// `weighed`. Returns whether the table is another one now.
bool pickBy(LightTable& lights, const HowLightsArePicked& how);

/// Gives the environment's picture, if there is one, another rotation (radians).
void turnEnvironment(LightTable& lights, float rotation);

// --- Samples of direct light ---------------------------------------------------------------------

/// How many samples find direct light at a shading point.
struct DirectSampling {
    uint32_t hemisphere = 0; ///< directions that are traced to whatever they meet
    uint32_t lights = 0;     ///< samples of lights, of all together
    uint32_t perLight =
        1; ///< of those, for one light where each is sampled in turn; else all of them
};

/// Throws std::invalid_argument if the lights were selected for a mode of direct light in which all
/// of them are sampled, and this one leaves some to rays, which would count them twice; or the
/// other way round.
DirectSampling directSampling(const LightTable& lights, const Estimator& settings);

} // namespace stromboli
