// Distances in media that are drawn about lamps near the ray (docs/theory/media.md, "Lamps that are near"), where some
// lamp of the scene is small beside the free path (the feature FOCI).

MediumFoci fetchFoci(uint medium) {
    const uvec4 r = ROW(materialRows, medium + MEDIUM_FOCI_ROW);
    return MediumFoci(r.x, uintBitsToFloat(r.y), 0u, 0u);
}

LightFocus fetchFocus(uint row) {
    const uvec4 r0 = ROW(materialRows, row), r1 = ROW(materialRows, row + 1u);
    return LightFocus(uintBitsToFloat(r0.xyz), uintBitsToFloat(r0.w), uintBitsToFloat(r1.x), uintBitsToFloat(r1.y), 0u, 0u);
}

/// How a stretch of a ray, which begins at the ray's tMin, lies to a lamp.
struct NearLamp {
    float closest;  ///< where it comes closest, from its beginning
    float square;   ///< of how close
    float perApart; ///< the inverse of that, taken together with the lamp's radius
};

NearLamp nearLamp(LightFocus focus, Traversal ray) {
    const vec3 d = focus.point - (ray.origin + ray.tMin * ray.direction);
    const float closest = dot(d, ray.direction);
    const vec3 across = d - closest * ray.direction;
    const float square = dot(across, across);
    return NearLamp(closest, square, inversesqrt(square + focus.radius * focus.radius));
}

/// The sine of the angle at which a place of the ray is seen from the lamp, from where it comes closest. Beyond a
/// million of that distance places are not told apart.
float sineOf(NearLamp n, float distance) {
    const float y = clamp((distance - n.closest) * n.perApart, -1e6, 1e6);
    return y * inversesqrt(1.0 + y * y);
}

/// A distance drawn about lamps, and how many of all distances are to be.
struct NearDraw {
    float share;    ///< at most 1/2
    float distance; ///< from the beginning of the stretch, within it
    float total;    ///< what the sum of the lamps' densities is divided by
};

const NearDraw NO_NEAR_DRAW = NearDraw(0.0, 0.0, 1.0);

/// The share of distances drawn by extinction that has the least second moment. rest: what arrives along the ray from all
/// else than `glow`, what lamps send into it; excess: by extinction alone, the second moment of that over its square.
float shareByExtinction(float rest, float glow, float excess) {
    const float gain = excess * (excess - 1.0);
    const bool gains = excess > 1.0 && glow * glow * gain > rest * rest;
    const float best = rest * excess / max(rest * (excess - 1.0) + glow * sqrt(max(gain, 0.0)), TINY);
    return gains ? max(best, 0.5) : 1.0;
}

/// Lamps that see less of the stretch, as the growth of the sine, are not near: it is a difference of rounded numbers.
const float LEAST_SINE = 0.0625;

/// medium: its first row. extinction, scattering: of what the path carries. u.x: chooses the lamp; u.y: the sine.
NearDraw drawNearLamps(uint medium, float extinction, float scattering, Traversal ray, float length_, vec2 u) {
    const MediumFoci foci = fetchFoci(medium);
    NearDraw r = NearDraw(0.0, 0.0, 0.0);
    float rest = 0.0, most = 0.0, squares = 0.0, which = u.x;
    for (uint i = 0u; i < FOCI; ++i) {
        const LightFocus focus = fetchFocus(foci.first + 2u * i);
        const NearLamp n = nearLamp(focus, ray);
        const float beyond = length_ - n.closest, square = focus.radius * focus.radius;
        const float end = smaller(n.square + beyond * beyond, INFINITE_DISTANCE);
        rest += focus.intensity * INV_PI / larger(end, square) + (end < 1.01 * square ? focus.radiance : 0.0);
        const float first = sineOf(n, 0.0), all = max(sineOf(n, length_) - first, 0.0);
        const float brings = focus.intensity * n.perApart, weight = brings * all;
        most += brings;
        squares += brings * n.perApart;
        r.total += weight;
        const float chance = weight / max(r.total, TINY), sine = first + u.y * all;
        const float distance = n.closest + sine * inversesqrt(max(1.0 - sine * sine, UNIT_ROUNDOFF)) / n.perApart;
        const bool takes = which < chance;
        r.distance = takes ? clamp(distance, 0.0, length_) : r.distance;
        which = takes ? which / chance : (which - chance) / max(1.0 - chance, TINY);
    }
    if (ray.hitPrimitive == NO_PRIMITIVE) rest = 0.0;
    // The integral of 1 / r^2 is about pi / 2 times the sines over the distance, that of 1 / r^4 pi / 4 over its cube.
    const float glow = 0.125 * scattering * r.total, excess = squares * INV_PI / max(extinction * r.total, TINY);
    const bool isNear = foci.first != 0u && r.total > LEAST_SINE * most;
    r.share = isNear ? 1.0 - shareByExtinction(foci.others + rest, glow, excess) : 0.0;
    return r;
}

/// Density of the distances that are drawn about lamps, per metre: a lamp's is as 1 / r^3.
float nearDensity(uint medium, NearDraw near, Traversal ray, float distance) {
    const uint first = fetchFoci(medium).first;
    float sum = 0.0;
    for (uint i = 0u; i < FOCI; ++i) {
        const LightFocus focus = fetchFocus(first + 2u * i);
        const NearLamp n = nearLamp(focus, ray);
        const float y = clamp((distance - n.closest) * n.perApart, -1e6, 1e6), cosine = inversesqrt(1.0 + y * y);
        sum += focus.intensity * n.perApart * n.perApart * cosine * cosine * cosine;
    }
    return sum / max(near.total, TINY);
}
