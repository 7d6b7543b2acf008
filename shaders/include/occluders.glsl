// Rectangles of walls, floors and ceilings that stop light samples (docs/theory/estimator.md, "Occluders"). What crosses one
// would meet the surface that it lies in: its ray need not be traced. host/kernel/find_occluders.hpp finds them.

Occluder occluderOf(const Frame frame, uint number) {
    const uint row = OCCLUDER_ROWS * number;
    return Occluder(frame.occluders[row], frame.occluders[row + 1u], frame.occluders[row + 2u]);
}

float atPoint(vec4 row, vec3 point) { return dot(row.xyz, point) + row.w; }

/// Whether a ray crosses it. direction: to the ray's end, unless it is infinite. least: of the square of its fall.
bool crosses(Occluder o, vec3 origin, vec3 direction, bool isInfinite, float least) {
    const float height = atPoint(o.plane, origin), fall = dot(o.plane.xyz, direction);
    const bool endsBehind = isInfinite || abs(fall) > abs(height) + 1.0;
    const vec3 at = origin - (height / fall) * direction;
    const float aside = max(abs(atPoint(o.across, at)), abs(atPoint(o.along, at)));
    // Ordered comparisons, which are false for NaN.
    return height * fall < 0.0 && abs(height) > 1.0 && endsBehind && fall * fall > least && aside < 1.0;
}

/// Whether the ray of a light sample is stopped for certain. direction: as crosses() takes it.
bool stopsAtOccluder(const Given given, vec3 origin, vec3 direction, bool isInfinite) {
    const float least = given.frame.leastFall * dot(direction, direction);
    bool stopped = false;
    for (uint i = 0u; i < OCCLUDERS; ++i) {
        const bool here = crosses(given.occluders.all[i], origin, direction, isInfinite, least);
        stopped = stopped || here;
    }
    return stopped;
}
