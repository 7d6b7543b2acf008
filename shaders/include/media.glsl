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

/// A hit as surfaceAt() says.
struct PassedPlace {
    bool outside; ///< the ray comes from where the normal, as stored, points to
    vec3 normal;  ///< unit
    float error;  ///< as SurfacePoint::error
};

PassedPlace placePassed(Traversal t) {
    PlacedPrimitive place = fetchPlace(t.hitPrimitive);
    const Placing placing = placingOf(t.hitPlacement);
    if (HAS_PLACEMENTS) place = inWorld(placing, place);
    vec3 normal = vec3(0.0);
    float error = 0.0;
    if (HAS_TRIANGLES && !place.isSphere) {
        const float b0 = 1.0 - t.b1 - t.b2;
        error = interpolationError(abs(b0 * place.v0) + abs(t.b1 * place.v1) + abs(t.b2 * place.v2));
        normal = triangleNormal(fetchPrimitive(place.primitive), place);
        if (HAS_PLACEMENTS && placing.isPlaced)
            normal = (placing.mirrors ? -1.0 : 1.0) * planeNormal(place.v1 - place.v0, place.v2 - place.v0);
    }
    if (HAS_SPHERES && place.isSphere) {
        normal = unit(t.origin + t.tMax * t.direction - place.v0);
        error = sphereError(place.v0, place.radius);
    }
    return PassedPlace(dot(normal, t.direction) <= 0.0, normal, error);
}

// --- Random numbers ------------------------------------------------------------------------------

/// What tells this stretch of this ray from all others, for any number of draws.
uvec4 mediumWords(const Frame frame, PathState path) {
    uint sample_ = sampleIndex(frame, path), block = path.bounce | MEDIUM_BLOCKS;
    addressBranch(path.splitPoint.bounce, path.branchesLeft, frame.branches, sample_, block);
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

#include "include/near_lights.glsl"

/// Free flight by one channel of three, which is drawn by what the channels carry, or to a distance that is drawn about
/// lamps; the density is that of all (Miller, Georgiev and Jarosz 2019, for a single collision). A medium without
/// scattering has a path's whole weight left. medium: the first row of `m`. The stretch begins at the ray's tMin.
MediumResult flyFreely(MediumBody m, uint medium, vec3 carried, Traversal ray, float length_, vec4 u) {
    MediumResult r = MediumResult(exp(-m.extinction * length_), vec3(0.0), false, false, 0.0);
    if (mediaDo(MEDIA_SHINE)) r.shone = m.emission * integratedTransmittance(m.extinction, length_);
    const bool mayScatter = mediaDo(MEDIA_SCATTER) && largestComponent(m.albedo) > 0.0;
    const vec3 share = carried / max(carried.x + carried.y + carried.z, TINY);
    NearDraw near = NO_NEAR_DRAW;
    float which = u.x;
    if (FOCI != 0u) {
        near = drawNearLamps(medium, dot(share, m.extinction), dot(share, m.albedo * m.extinction), ray, length_, u.zw);
        which = (u.x - near.share) / (1.0 - near.share);
    }
    const float rate = which < share.x ? m.extinction.x : (which < share.x + share.y ? m.extinction.y : m.extinction.z);
    r.distance = rate > 0.0 ? -log(1.0 - u.y) / rate : INFINITE_DISTANCE;
    r.scatters = mayScatter && r.distance < length_;
    if (FOCI != 0u && which < 0.0) {
        r.distance = near.distance;
        r.scatters = true;
    }
    const vec3 left = exp(-m.extinction * min(r.distance, length_));
    const vec3 density = r.scatters ? m.extinction * left : left;
    float drawn = dot(share, density);
    if (FOCI != 0u)
        drawn = (1.0 - near.share) * drawn + (r.scatters ? near.share * nearDensity(medium, near, ray, r.distance) : 0.0);
    if (mayScatter) r.weight = (r.scatters ? m.albedo * density : density) / max(drawn, TINY);
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
    Filling filling = path.filling;
    if (!isPath) filling = path.shadowFilling;
    const uint here = filling.medium;
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
        if (isPath && !varies && !SEES) r = flyFreely(m, here, carried, path.ray, length_, mediumNumbers(words, 0u));
        if (varies) r = trackGrid(m, here, path.ray, carried, isPath && !SEES, words);
        if (SEES) path.seen.albedo.xyz += path.throughput * (1.0 - r.weight) * m.albedo;
        if (mediaDo(MEDIA_SHINE) && isPath && countedBounces(path.bounce, path.uncounted) >= given.frame.minBounce) path.radiance += limited(path, path.throughput * r.shone);
        if (isPath) path.throughput *= r.weight;
        else path.directValue *= r.weight;
        isUnderWay = r.isUnderWay;
        if (isUnderWay) {
            goOnFrom(path.ray, path.ray.tMin + r.distance / perUnit, path.rayEnd);
            if (PASSES_BORDERS) path.crossing = Crossing(filling, -1.0, false);
        } else if (isPath && r.scatters) {
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

/// Bound of the distance, along the normal, of the plane of a hit from where a ray from `origin` meets it. error: as
/// SurfacePoint::error (docs/theory/numerics.md, "Surfaces in one plane").
float planeError(float error, vec3 normal, vec3 origin) {
    return offsetLength(error + 32.0 * UNIT_ROUNDOFF * largestComponent(abs(origin)), normal);
}

/// Whether what the ray has hit lies in the plane of what it has passed last, as far as rounding tells.
bool isInPassedPlane(Traversal t, Crossing c, vec3 normal, float error) {
    return c.error >= 0.0 && (t.tMax - t.tMin) * abs(dot(t.direction, normal)) <= c.error + error;
}

/// The medium of a ray that passes the surface that it has hit. Of two borders in one plane, the one that says where the
/// ray has come from is passed first.
void passIntoMedium(inout PathState path) {
    if (!HAS_MEDIA) return;
    const bool isPath = path.phase == PHASE_PATH;
    Filling here = path.filling;
    if (!isPath) here = path.shadowFilling;
    const PassedPlace place = placePassed(path.ray);
    const MediumBorder border = fetchBorder(materialOf(fetchPrimitive(fetchPlace(path.ray.hitPrimitive).primitive)));
    const uint before = place.outside ? border.outside : border.inside;
    const float error = planeError(place.error, place.normal, path.ray.origin);
    const bool isSamePlane = isInPassedPlane(path.ray, path.crossing, place.normal, error);
    if (!isSamePlane) path.crossing.filling = here;
    // Volumes are in no order.
    const bool isOfMedia = border.isBorder == BORDER_OF_MEDIA;
    const bool isEarlier = isOfMedia && isSamePlane && path.crossing.isUntold && before == path.crossing.filling.medium;
    path.crossing.error = error;
    path.crossing.isUntold = isOfMedia && !isEarlier && before != here.medium;
    if (!isEarlier) here = fillingBehind(border, here, place.outside);
    if (isPath) path.filling = here;
    else path.shadowFilling = here;
}

/// At path.surface: a border in its plane is not passed.
void settleMedium(inout PathState path) {
    const SurfacePoint s = path.surface;
    const float error = planeError(s.error, s.geometric, path.ray.origin);
    if (isInPassedPlane(path.ray, path.crossing, s.geometric, error)) path.filling = path.crossing.filling;
}
