// Surfaces that are partly not there, as rays meet them. A hit is an event of its own, before anything is shaded: the ray
// goes on from the same origin, with tMin at the hit (traverse.glsl), or is done.

bool isTracing(uint p); // path_state.glsl
void passIntoMedium(inout PathState path); // media.glsl
bool scattersInMedium(Traversal ray);

Material materialAt(SurfacePoint s) { return lookUpMaterial(materialPoint(s)).parameters; }

/// hitWords() of the ray that is done.
uvec4 hitWordsOfPath(const Frame frame, PathState path) {
    uint sample_ = sampleIndex(frame, path), block = path.bounce * (1u + directSamples(frame));
    if (DIRECT_LIGHT == DIRECT_HEMISPHERE && path.phase == PHASE_HEMISPHERE) block += path.directIndex;
    addressBranch(path.splitPoint.bounce, path.branchesLeft, frame.branches, sample_, block);
    return hitWords(frame.seed, path.ray, path.pixelId, sample_, block);
}

/// Whether the ray that is done goes on: it has met a surface that is not there, or partly. A shadow ray goes on with
/// the light that is left; of others, a path that finds light or scatters, the surface takes the share of its opacity.
/// hit: the surface's point, with that opacity.
bool passesThrough(const Frame frame, inout PathState path, MaterialPoint hit, float stated) {
    if (!isTracing(path.phase) || path.ray.hitPrimitive == NO_PRIMITIVE || scattersInMedium(path.ray)) return false;
    const bool isStraight = HIDES_SURFACES && path.phase == PHASE_PATH && path.bounce == 0u;
    const float opacity = isStraight ? opacityForCamera(hit, stated) : stated;
    if (isToLight(path.phase)) {
        path.directValue *= 1.0 - opacity;
        if (LIGHT_THROUGH_GLASS && opacity < 1.0) path.glass.share *= 1.0 - opacity;
        if (!(dot(path.directValue, vec3(1.0)) > 0.0)) return false;
    } else if (hitNumber(hitWordsOfPath(frame, path), 0u) < opacity) {
        return false;
    }
    passIntoMedium(path);
    passOn(path.ray, path.rayEnd);
    return true;
}

/// Whether the ray has begun before where it is now: a camera ray begins anew.
bool hasPassedSomething(PathState path) {
    return HAS_ALPHA && path.ray.passed != NO_PRIMITIVE || mediaDo(MEDIA_VARY) && path.bounce > 0u && path.ray.tMin > 0.0;
}
