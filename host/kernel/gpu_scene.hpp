#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/detail_plan.hpp"
#include "host/kernel/detail_rows.hpp"
#include "host/kernel/find_lit_cells.hpp"
#include "host/kernel/find_portals.hpp"
#include "host/kernel/light_guide.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/material_rows.hpp"
#include "host/kernel/occluders.hpp"
#include "host/kernel/rows.hpp"
#include "host/kernel/shadow_map.hpp"
#include "host/render/settings.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <optional>
#include <vector>

namespace stromboli {

// --- The scene -----------------------------------------------------------------------------------

/// The scene in the arrays that the kernel reads, ready to upload.
struct GpuScene {
    WideLayout bvh;                         ///< leaves name the lights that they are
    std::vector<gpu::Primitive> primitives; ///< in the order of the tree's leaves
    std::vector<Row> materials;
    DetailRows details; ///< attributes of corners, and texels
    LightTable lights;
    Portals portals; ///< of the picture to come; packScene() leaves it empty
    std::optional<LightGuide>
        guide; ///< likewise (guideThatPays()); none: light samples are not guided
    std::optional<LitCells>
        lit;             ///< where bounces aim; none: not looked for, as packScene() leaves it
    Occluders occluders; ///< likewise (findOccluders()): of light samples
    /// Whether kernels look at them: as pays in the first picture, so that others need no other
    /// kernel; packScene() leaves it unknown.
    std::optional<bool> looksAtOccluders;
    std::optional<ShadowMap> shadowMap;   ///< likewise (castShadows()); none: of no light
    std::optional<bool> looksAtShadowMap; ///< likewise
    double glassBeforeLights =
        0;                  ///< shareThroughGlass() of the picture to come; packScene() leaves it 0
    VisitsOfRay ofRay;      ///< visitsOfRay() of its first picture; packScene() leaves it unknown
    SceneClosures closures; ///< of the materials that primitives have
    bool hasEmission = false;                ///< a primitive emits
    bool hasBlends = false;                  ///< a primitive's material is a mixture
    uint32_t mostOthers = 0, mostBlends = 0; ///< of MaterialRows
    bool hasBlackBacks = false;              ///< a primitive's material is black behind
    bool hasReliefRules = false;             ///< MATERIAL_RELIEF_ or DETAIL_MIRRORS_RELIEF bits
    bool hasDispersion = false;              ///< a primitive's material refracts by colour
    bool hasIridescence = false;             ///< a primitive's material has a thin film
    uint32_t media = 0;                      ///< MEDIA_ bits
    std::vector<uint32_t> mediumRow;         ///< by medium of the scene: its first row
    uint32_t foci = 0;                       ///< lamps about which distances in media are drawn
    float gapWidth = 0;                      ///< gapWidth()
    bool hasTriangles = false, hasSpheres = false;
    bool hasNormals = false; ///< any triangle with shading normals
    bool hasPlacements = false;
    DetailPlan detailPlan; ///< that `details` follow; of it:
    uint32_t textureSlots = 0, looseSlots = 0, texelKinds = 0, attributes = 0, mostTextures = 0;
    bool hasAlpha = false, hasHidden = false, hasTangentFrames = false;
};

/// Packs the scene, whose hierarchy is `bvh`. For a render `lights` is lightSelection() of its
/// settings; by default all lights are sampled. environment: of the scene's environment, where it
/// was packed before (LightTable::environment). gatheredRows: of planDetails(). before: of a scene
/// that has the same meshes and textures, with objects elsewhere, packed with the same
/// gatheredRows; null: there is none.
GpuScene packScene(const Scene& scene, WideLayout bvh, const LightSelection& lights = {},
                   std::shared_ptr<const EnvironmentTable> environment = {},
                   uint64_t gatheredRows = kUsualGatheredRows, const GpuScene* before = nullptr);

/// Whether both materials differ in numbers alone: colours, roughness, indices and emission, but in
/// no texture, opacity, mixture or medium.
bool differInNumbers(const Material& a, const Material& b);

/// Whether other textures count in the scene than in the one that `packed` was packed from, with
/// the same gatheredRows: one multiplies a number that is no longer 0, or one that is 0 now.
bool wantsOtherTextures(const GpuScene& packed, const Scene& scene, uint64_t gatheredRows);

/// Brings into `packed`, which was packed from `scene` with the same `lights`, what has become of
/// the numbers of its materials (differInNumbers()). The tree and the textures stay as they are.
/// hasOtherEnvironment: there is another environment around the scene too. Returns the bindings
/// (BINDING_ of shaders/shared/interface.h) whose contents have changed.
std::vector<uint32_t> repackMaterials(GpuScene& packed, const Scene& scene,
                                      const LightSelection& lights,
                                      bool hasOtherEnvironment = false);

/// Gives the scene's environment another rotation, in radians. Its tables stay as they are. Returns
/// the bindings whose contents have changed.
std::vector<uint32_t> turnEnvironment(GpuScene& packed, float rotation);

/// First row of the primitive's material.
inline uint32_t materialOf(const gpu::Primitive& p) {
    return p.material & ~gpu::PRIMITIVE_IS_SMOOTH;
}
inline gpu::MaterialHeader materialHeader(const GpuScene& scene, const gpu::Primitive& p) {
    return structureAt<gpu::MaterialHeader>(scene.materials, materialOf(p));
}

/// Octahedral encoding of a unit vector (Meyer et al. 2010), two 16-bit signed fractions.
uint32_t encodeNormal(const glm::vec3& n);
/// The unit vector of a code, as the shaders decode it but for rounding.
glm::vec3 decodeNormal(uint32_t code);

// --- The gap -------------------------------------------------------------------------------------

/// Width of the gap that the gap proposal aims at: the space between a scene's only light, a
/// rectangle, and a diffuse surface close to it. What leaves the gap comes from few directions,
/// into which the kernel sends some bounces (shaders/include/gap_proposal.glsl;
/// docs/theory/estimator.md, "Gaps"). In scene units; positive on the side that edgeA x edgeB
/// points to, negative on the other; 0: there is no gap.
float gapWidth(const GpuScene& scene);

} // namespace stromboli
