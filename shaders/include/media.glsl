// The stage between a ray's end and what is there: what the media on its way do to the path (docs/theory/media.md). A ray
// of a path either scatters in a medium, which ends it there, or goes on with what is left; a ray to a light keeps its
// transmittance. Surfaces between media that light only passes are met like all that has an opacity (pass_through.glsl),
// so that a ray goes through one medium at a time: from tMin, where it began or has passed a surface, to tMax.

/// In place of a primitive that a ray has hit: it has scattered in a medium.
const uint IN_MEDIUM = 0xFFFFFFFEu;

bool scattersInMedium(Traversal ray) { return HAS_MEDIA && ray.hitPrimitive == IN_MEDIUM; }

MediumBody fetchMedium(uint medium) {
    const uint row = medium + MEDIUM_BODY_ROW;
    const uvec4 r0 = ROW(materialRows, row), r1 = ROW(materialRows, row + 1u), r2 = ROW(materialRows, row + 2u);
    return MediumBody(uintBitsToFloat(r0.xyz), uintBitsToFloat(r0.w), uintBitsToFloat(r1.xyz), r1.w,
                      uintBitsToFloat(r2.xyz), uintBitsToFloat(r2.w));
}

/// Whether a ray that has hit something meets it from where its normal, as stored, points to: as surfaceAt() says.
bool meetsOutside(Traversal t) {
    PlacedPrimitive place = fetchPlace(t.hitPrimitive);
    const Placing placing = placingOf(t.hitPlacement);
    if (HAS_PLACEMENTS) place = inWorld(placing, place);
    vec3 normal = vec3(0.0);
    if (HAS_TRIANGLES && !place.isSphere) {
        normal = triangleNormal(fetchPrimitive(place.primitive), place);
        if (HAS_PLACEMENTS && placing.isPlaced)
            normal = (placing.mirrors ? -1.0 : 1.0) * planeNormal(place.v1 - place.v0, place.v2 - place.v0);
    }
    if (HAS_SPHERES && place.isSphere) normal = t.origin + t.tMax * t.direction - place.v0;
    return dot(normal, t.direction) <= 0.0;
}

// --- Random numbers ------------------------------------------------------------------------------

/// Blocks of random numbers that media take.
const uint MEDIUM_BLOCKS = 0x20000000u;

/// What tells this stretch of this ray from all others, for any number of draws.
uvec4 mediumWords(const Frame frame, PathState path) {
    uint sample_ = sampleIndex(frame, path), block = path.bounce | MEDIUM_BLOCKS;
    if (SPLITS && path.splitPoint.bounce != 0u) {
        sample_ = sample_ * frame.branches + frame.branches - 1u - path.branchesLeft;
        block |= BRANCH_BLOCKS;
    }
    const uint ofLightSample = path.phase == PHASE_PATH ? 0u : 1u + path.directIndex;
    return pcg4d(uvec4(path.pixelId, sample_, block, frame.seed)) ^ uvec4(floatBitsToUint(path.ray.tMin), ofLightSample, 0u, 0u);
}

vec4 mediumNumbers(uvec4 words, uint draw) {
    words.z ^= draw;
    return unitFloats(pcg4d(words));
}

// --- Media that are the same everywhere ------------------------------------------------------------

/// The integral of exp(-extinction s) over s in [0, length_].
vec3 integratedTransmittance(vec3 extinction, float length_) {
    const vec3 x = extinction * length_;
    const vec3 series = length_ * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
    return mix((1.0 - exp(-x)) / max(extinction, vec3(TINY)), series, lessThan(x, vec3(0.0625)));
}

/// What has become of a path on a stretch.
struct MediumResult {
    vec3 weight;    ///< of the path, for what follows
    vec3 shone;     ///< radiance that the medium has sent into the path
    bool scatters;
    bool isUnderWay; ///< the stretch has not come to its end: it goes on from `distance`
    float distance;  ///< from the stretch's beginning to where it scatters
};

/// Free flight by one channel of three, which is drawn by what the channels carry; the density is that of all (Miller,
/// Georgiev and Jarosz 2019, for a single collision). A medium without scattering has a path's whole weight left.
MediumResult flyFreely(MediumBody m, vec3 carried, float length_, vec4 u) {
    MediumResult r = MediumResult(exp(-m.extinction * length_), vec3(0.0), false, false, 0.0);
    if (mediaDo(MEDIA_SHINE)) r.shone = m.emission * integratedTransmittance(m.extinction, length_);
    const vec3 share = carried / max(carried.x + carried.y + carried.z, TINY);
    const float rate = u.x < share.x ? m.extinction.x : (u.x < share.x + share.y ? m.extinction.y : m.extinction.z);
    r.distance = rate > 0.0 ? -log(1.0 - u.y) / rate : INFINITE_DISTANCE;
    const bool mayScatter = mediaDo(MEDIA_SCATTER) && largestComponent(m.albedo) > 0.0;
    r.scatters = mayScatter && r.distance < length_;
    const vec3 left = exp(-m.extinction * min(r.distance, length_));
    const vec3 density = r.scatters ? m.extinction * left : left;
    if (mayScatter) r.weight = (r.scatters ? m.albedo * density : density) / max(dot(share, density), TINY);
    return r;
}

// --- Grids of densities ------------------------------------------------------------------------------

#include "include/density_grid.glsl"

// --- The stage ----------------------------------------------------------------------------------------

/// The ray goes on from farther away, to its own end; what it has hit is found again.
void goOnFrom(inout Traversal t, float from, float end) {
    // Farther in any case, where steps are less than floats can tell.
    t.tMin = larger(from, uintBitsToFloat(floatBitsToUint(t.tMin) + 1u));
    t.passed = NO_PRIMITIVE;
    t.tMax = end;
}

/// Takes in what the ray that is done has gone through, and makes IN_MEDIUM its end if it has scattered. Returns whether
/// the ray is under way still: so much of a grid is tracked at a time as loops may take. What only sees takes the share
/// that is left, and the medium's albedo for the rest.
bool goThroughMedium(const Given given, inout PathState path) {
    if (!HAS_MEDIA) return false;
    const bool isPath = path.phase == PHASE_PATH;
    const uint here = isPath ? path.medium : path.shadowMedium;
    const bool isBlocked = !isPath && path.phase == PHASE_SHADOW && !HAS_ALPHA && path.ray.hitPrimitive != NO_PRIMITIVE;
    bool isUnderWay = false;
    if (isTracing(path.phase) && here != NO_MEDIUM && !isBlocked) {
        const MediumBody m = fetchMedium(here);
        const float perUnit = isPath ? 1.0 : length(path.ray.direction);
        const float length_ = (path.ray.tMax - path.ray.tMin) * perUnit;
        const uvec4 words = mediumWords(given.frame, path);
        const vec3 carried = isPath ? path.throughput : path.directValue;
        MediumResult r = MediumResult(exp(-m.extinction * length_), vec3(0.0), false, false, 0.0);
        const bool varies = mediaDo(MEDIA_VARY) && m.grid != 0u;
        if (isPath && !varies && !SEES) r = flyFreely(m, carried, length_, mediumNumbers(words, 0u));
        if (varies) r = trackGrid(m, here, path.ray, carried, isPath && !SEES, words);
        if (SEES) path.seen.albedo.xyz += path.throughput * (1.0 - r.weight) * m.albedo;
        if (mediaDo(MEDIA_SHINE) && isPath && path.bounce >= given.frame.minBounce) path.radiance += limited(path, path.throughput * r.shone);
        if (isPath) path.throughput *= r.weight;
        else path.directValue *= r.weight;
        isUnderWay = r.isUnderWay;
        if (isUnderWay) goOnFrom(path.ray, path.ray.tMin + r.distance / perUnit, path.rayEnd);
        else if (isPath && r.scatters) {
            path.ray.tMax = path.ray.tMin + r.distance;
            path.ray.hitPrimitive = IN_MEDIUM;
        }
    }
    return isUnderWay;
}

/// Where the ray has scattered, as a point that paths leave like a surface's: without normals, and with nothing to skip.
SurfacePoint pointInMedium(Traversal t, uint medium) {
    SurfacePoint s;
    s.position = t.origin + t.tMax * t.direction;
    s.error = s.lift = 0.0;
    s.geometric = s.shading = s.coat = vec3(0.0);
    s.wo = -t.direction;
    s.outside = true;
    s.material = medium;
    s.skipPrimitive = s.primitive = NO_PRIMITIVE;
    s.weights = vec2(0.0);
    s.tangent = vec4(0.0);
    s.placement = NO_PLACEMENT;
    s.mixture = NO_MIXTURE;
    return s;
}

/// The medium of a ray that passes the surface that it has hit.
void passIntoMedium(inout PathState path) {
    if (!HAS_MEDIA) return;
    const uint material = materialOf(fetchPrimitive(fetchPlace(path.ray.hitPrimitive).primitive));
    const bool outside = meetsOutside(path.ray);
    if (path.phase == PHASE_PATH) path.medium = mediumBehind(material, path.medium, outside);
    else path.shadowMedium = mediumBehind(material, path.shadowMedium, outside);
}
