#pragma once

#include "host/reference/sampling.hpp"
#include "host/reference/surface.hpp"
#include "shaders/shared/bsdf_types.h"

namespace stromboli::reference {

/// Value and density of a BSDF for one pair of directions; both 0 where nothing scatters.
struct BsdfValue {
    glm::dvec3 value{0.0}; ///< f |cos(wi, shading normal)|
    double pdf = 0;        ///< density of sampleBsdf(), by solid angle
};

/// A sampled direction.
struct BsdfSample {
    glm::dvec3 direction{0, 0, 1};                ///< unit, world space, away from the surface
    glm::dvec3 weight{0.0};                       ///< f |cos| / pdf; 0 ends the path
    double pdf = 0;                               ///< by solid angle; delta lobes: of no meaning
    uint32_t lobe = gpu::LOBE_DIFFUSE_REFLECTION; ///< one gpu::LOBE_ bit
    glm::dvec3 left{1.0}; ///< the share of the weight whose lights are left to bounces
    double chosen = 1;    ///< delta lobes: the probability of their choice

    bool transmitted() const { return lobe & gpu::TRANSMISSION_LOBES; } ///< to the other side
    bool isDelta() const { return lobe & gpu::DELTA_LOBES; }
};

/// The frame that materials scatter in: z along the shading normal, x the tangent,
/// where the surface has one.
Frame surfaceFrame(const SurfacePoint& surface);
/// Whether light that comes from the other side of the surface is scattered into many directions.
bool isLitFromBehind(const Material& material);
bool isLitFromBehind(const SurfacePoint& surface);

/// Whether bounces from there find all light that they can, and light samples go to the rest only.
/// The kernel shares the light between both.
bool leavesLightsToBounces(const Material& material);
/// Whether all materials do.
bool leavesLightsToBounces(const SurfacePoint& surface);
/// Whether its surface bounds an inside, which may absorb.
bool boundsVolume(const Material& material);
/// The absorption coefficient of the inside, per metre.
glm::dvec3 absorptionInside(const Material& material);

/// All lobes of a material, or of the materials that scatter together there, gpu::LOBE_ bits.
uint32_t lobesOf(const Material& material);
uint32_t lobesOf(const SurfacePoint& surface);
/// Whether light samples can find light that these lobes scatter.
bool scattersIntoManyDirections(uint32_t lobes);
/// Whether two paths that arrive by the same ray may leave by different ones.
bool scattersAtRandom(uint32_t lobes);

/// For a unit world direction wi away from the surface, of all lobes but delta ones. The surface is
/// faced forward.
BsdfValue evaluateBsdf(const SurfacePoint& surface, const glm::dvec3& wi,
                       const ShadingConventions& conventions);
/// What is not left to bounces of it.
BsdfValue evaluateForLights(const SurfacePoint& surface, const glm::dvec3& wi,
                            const ShadingConventions& conventions);

/// Samples the direction of the next bounce, from the drawn material; the density is that of all.
/// u, each uniform in [0, 1): x and y for the direction within a lobe, z for the choice of one of
/// several lobes. The surface is faced forward.
BsdfSample sampleBsdf(const SurfacePoint& surface, const glm::dvec3& u,
                      const ShadingConventions& conventions);

} // namespace stromboli::reference
