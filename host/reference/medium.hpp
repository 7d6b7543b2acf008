#pragma once

#include "host/reference/bvh.hpp"
#include "host/reference/sampling.hpp"
#include "scene/model/light_foci.hpp"
#include "scene/model/medium.hpp"

namespace stromboli::reference {

// Media (docs/theory/media.md). Distances are along rays, whose directions are unit vectors.

/// What becomes of a path on a stretch of a ray through one medium.
struct MediumEvent {
    glm::dvec3 weight{1.0}; ///< of the path, for what follows
    glm::dvec3 shone{0.0};  ///< radiance that the medium sends into the path
    bool scatters = false;
    double distance = 0; ///< on the ray, where it scatters
};

/// A rate that the extinction of one that varies nowhere exceeds, per metre. Takes time in
/// proportion to its cells.
double mostExtinction(const Medium& medium);

/// carried: what the path's channels carry, by which one of them is drawn. most: mostExtinction().
/// foci: the lamps about which distances are drawn in a medium that is the same everywhere; null:
/// none.
MediumEvent flyThrough(const Medium& medium, double most, const Ray& ray, double from, double to,
                       const glm::dvec3& carried, const LightFoci* foci, RandomStream& random);

/// The share of light that is left between two distances, the second of which may be infinite. No
/// estimate: of a grid it is the exponential of an integral that is exact but for rounding.
glm::dvec3 transmittance(const Medium& medium, const Ray& ray, double from, double to);

/// Density of the phase function, by solid angle, at the cosine between the directions before and
/// after.
double phaseDensity(const Medium& medium, double cosine);

/// The part of it that is of narrow functions, which light samples seldom meet.
double narrowPhaseDensity(const Medium& medium, double cosine);

/// Whether all of it is.
bool isNarrow(const Medium& medium);

/// A direction in proportion to it. forward: unit, the way the light goes; u, v: in [0, 1).
glm::dvec3 samplePhase(const Medium& medium, const glm::dvec3& forward, double u, double v);

} // namespace stromboli::reference
