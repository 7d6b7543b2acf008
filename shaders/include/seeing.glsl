// What the camera sees, without light (docs/guide/layers.md): the integrators INTEGRATOR_COVERAGE and INTEGRATOR_LAYERS. A
// sample is a camera ray, and what follows from it in mirrors, glass and smooth metal. In place of radiance it adds to
// sums of the pixel (shared/layer_types.h), which lie behind its state in the film.

#include "closures/seen_surface.glsl"

/// The camera ray has met a surface, whose place is kept if it is the pixel's first.
void countHit(inout PathState path) {
    if (SEES_SURFACES && path.seen.hits == 0u) {
        path.seen.primitive = primitiveAt(path.ray.hitPrimitive);
        path.seen.b1 = path.ray.b1;
        path.seen.b2 = path.ray.b2;
        path.seen.placement = NO_SEEN_PLACEMENT;
        if (HAS_PLACEMENTS && path.surface.placement != NO_PLACEMENT)
            path.seen.placement = fetchPlacement(path.surface.placement).placement & ~PLACEMENT_MIRRORS;
    }
    ++path.seen.hits;
    path.seen.covered += samplesHaveWeights() ? path.filterWeight : 1.0;
}

#define ADD_VALUE(name, value, otherwise) seen.name.xyz += value;
#define ADD_OTHERWISE(name, value, otherwise) seen.name.xyz += otherwise;

void addSumsOfFirst(inout SeenPixel seen, vec3 tint, Material m, SurfacePoint s) {
    SUMS_OF_FIRST(ADD_VALUE)
}

/// The surface is what is seen in the end.
void endAtSurface(inout SeenPixel seen, vec3 tint, Material m, SurfacePoint s) {
    SUMS_OF_END(ADD_VALUE)
}

/// Nothing is seen in what the ray has met.
void endAtNothing(inout SeenPixel seen, vec3 tint, vec3 firstNormal) {
    SUMS_OF_END(ADD_OTHERWISE)
}

#undef ADD_VALUE
#undef ADD_OTHERWISE

/// The ray has met nothing; a mirror may show that.
void seeNothing(inout PathState path) {
    if (SEES_SURFACES && path.bounce == 0u) path.seen.transmittance.xyz += path.throughput;
    if (SEES_SURFACES && path.bounce > 0u) endAtNothing(path.seen, path.throughput, path.firstNormal);
}

/// At the surface, as it is shaded: ends there, or goes on to what is seen in it.
void seeSurface(inout PathState path) {
    if (path.bounce == 0u) {
        path.firstNormal = shadingNormal(path.surface);
        addSumsOfFirst(path.seen, path.throughput, path.material, path.surface);
    }
    ++path.bounce;
    if (!isSeenThrough(path.material)) endAtSurface(path.seen, path.throughput, path.material, path.surface);
    else if (path.bounce > MOST_SEEN_THROUGH) endAtNothing(path.seen, path.throughput, path.firstNormal);
    else path.phase = PHASE_BOUNCE;
}
