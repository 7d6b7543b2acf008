// The way of a light sample through clear glass (clear_glass.glsl), as one of a path's: its ray has become a path ray, which
// every surface of glass lets through and everything else ends, while the path waits at the surface that it was taken at.

/// The ray of the light sample has met what may be clear glass, where it goes on.
void enterGlass(inout PathState path) {
    const bool isBehindSurface = isBehind(path.surface, path.glass.direction);
    path.glass.isUnderWay = true;
    path.glass.surface = path.surface;
    path.glass.material = path.material;
    path.glass.throughput = path.throughput;
    path.glass.bounce = path.bounce;
    path.glass.filling = path.filling;
    path.departurePoint = litPoint(sideLit(path.surface, path.material, isBehindSurface));
    path.filling = fillingBeyond(path.surface, path.material, path.filling, isBehindSurface);
    path.throughput *= path.glass.share;
    path.countsEmission = true;
    if (AIMS_BOUNCES) path.aim.bsdfPdf = 0.0;
    const float segment = length(path.ray.direction);
    path.ray.direction /= segment;
    path.ray.tMax *= segment;
    path.phase = PHASE_PATH;
}

/// What the light sample has found: its light, share being 1, or anything else.
void arriveThroughGlass(inout PathState path, vec3 light, float share) {
    if (RECORDS && share > 0.0) recordArrivedLight(path, light);
}

/// Goes back to the surface that the light sample was taken at, once its way has ended.
void comeBackFromGlass(inout PathState path) {
    if (isThroughGlass(path) && path.phase == PHASE_ENDED) {
        path.glass.isUnderWay = false;
        path.surface = path.glass.surface;
        path.material = path.glass.material;
        path.throughput = path.glass.throughput;
        path.bounce = path.glass.bounce;
        path.filling = path.glass.filling;
        path.phase = PHASE_DIRECT;
    }
}

/// The path ray has come through glass from a surface that takes light samples, or is one's.
bool isBehindGlass(PathState path) {
    return LIGHT_THROUGH_GLASS && (path.glass.isUnderWay || path.glass.panes > 0u);
}

bool keepsDirection(PathState path) {
    const vec3 turn = path.ray.direction - path.glass.direction;
    return isBehindGlass(path) && dot(turn, turn) <= SAME_DIRECTION;
}

/// In which the sky is looked up: where glass has turned it by rounding alone, as light samples see it.
vec3 directionToSky(PathState path) { return keepsDirection(path) ? path.glass.direction : path.ray.direction; }

/// Remembers what the weight of light depends on that this bounce finds behind glass. False: it goes through glass, and
/// what is remembered of the last bounce holds.
bool departs(const Frame frame, inout PathState path, BsdfSample b) {
    bool goesThrough = false;
    if (LIGHT_THROUGH_GLASS) {
        const bool isGlass = b.lobe == LOBE_DELTA_TRANSMISSION && path.glass.isFromLit && path.glass.panes < MOST_PANES;
        goesThrough = path.glass.isUnderWay || isGlass;
        if (!goesThrough) {
            path.glass.direction = b.direction;
            path.glass.isFromLit = !isDelta(b.lobe) && countedBounces(path.bounce, path.uncounted) >= frame.minBounce;
        }
        if (!path.glass.isUnderWay) path.glass.panes = isGlass ? path.glass.panes + 1u : 0u;
    }
    return !goesThrough;
}
