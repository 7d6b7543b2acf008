// What the camera sees, without light (docs/guide/layers.md): the integrators INTEGRATOR_COVERAGE and INTEGRATOR_LAYERS. A
// sample is a camera ray, and what follows from it in mirrors, glass and smooth metal. In place of radiance it adds to
// sums behind its pixel's state in the film (shared/layer_types.h), which no other lane has in hand.

#include "closures/seen_surface.glsl"

uint seenRow(PathState path) { return PIXEL_ROWS * path.pixelInFilm + PIXEL_STATE_ROWS; }

void addToRow(uint row, vec3 value) {
    uvec4 sum = ROW(pixelRows, row);
    sum.xyz = floatBitsToUint(uintBitsToFloat(sum.xyz) + value);
    STORE_ROW(pixelRows, row, sum);
}

/// The camera ray has met a surface, whose place is kept if it is the pixel's first.
void countHit(PathState path) {
    const uint row = seenRow(path);
    uvec4 counts = ROW(pixelRows, row);
    if (SEES_SURFACES && counts.x == 0u) {
        counts.z = primitiveAt(path.ray.hitPrimitive);
        counts.w = NO_SEEN_PLACEMENT;
        if (HAS_PLACEMENTS && path.surface.placement != NO_PLACEMENT)
            counts.w = fetchPlacement(path.surface.placement).placement & ~PLACEMENT_MIRRORS;
        STORE_ROW(pixelRows, row + 1u, uvec4(floatBitsToUint(vec2(path.ray.b1, path.ray.b2)), 0u, 0u));
    }
    ++counts.x;
    const float weight = samplesHaveWeights() ? path.filterWeight : 1.0;
    counts.y = floatBitsToUint(uintBitsToFloat(counts.y) + weight);
    STORE_ROW(pixelRows, row, counts);
}

void addSumsOfFirst(PathState path, Material m, SurfacePoint s) {
    uint row = seenRow(path) + SEEN_HEAD_ROWS;
#define ADD_SUM(name, value, otherwise) addToRow(row++, value);
    SUMS_OF_FIRST(ADD_SUM)
#undef ADD_SUM
}

/// The surface is what is seen in the end.
void endAtSurface(PathState path, Material m, SurfacePoint s) {
    const vec3 tint = path.throughput;
    uint row = seenRow(path) + SEEN_HEAD_ROWS + SEEN_FIRST_ROWS;
#define ADD_SUM(name, value, otherwise) addToRow(row++, value);
    SUMS_OF_END(ADD_SUM)
#undef ADD_SUM
}

/// Nothing is seen in what the ray has met so far.
void endAtNothing(vec3 tint, PathState path) {
    const vec3 firstNormal = path.firstNormal;
    uint row = seenRow(path) + SEEN_HEAD_ROWS + SEEN_FIRST_ROWS;
#define ADD_SUM(name, value, otherwise) addToRow(row++, otherwise);
    SUMS_OF_END(ADD_SUM)
#undef ADD_SUM
}

/// The ray has met nothing; a mirror may show that.
void seeNothing(PathState path) {
    if (SEES_SURFACES && path.bounce > 0u) endAtNothing(path.throughput, path);
}

/// At the surface, as it is shaded: ends there, or goes on to what is seen in it.
void seeSurface(inout PathState path) {
    if (path.bounce == 0u) {
        path.firstNormal = shadingNormal(path.surface);
        addSumsOfFirst(path, path.material, path.surface);
    }
    ++path.bounce;
    if (!isSeenThrough(path.material)) endAtSurface(path, path.material, path.surface);
    else if (path.bounce > MOST_SEEN_THROUGH) endAtNothing(path.throughput, path);
    else path.phase = PHASE_BOUNCE;
}
