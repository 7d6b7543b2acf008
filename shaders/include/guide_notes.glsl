// What a kernel writes down of its light samples, for the guide to learn from (shared/guide_types.h).

/// The place of a path's note: the picture that is noted has no branches, begins with sample 0, and takes as many
/// samples of each pixel.
uint lightNoteRow(const Frame frame, PathState path) {
    const uint path_ = path.pixelId * frame.notedSamples + sampleIndex(frame, path);
    return (path_ * GUIDE_VERTICES + path.bounce - 1u) * LIGHT_NOTE_ROWS;
}

/// A light sample has been taken at the path's surface that brings `value`, unless it is shaded.
void noteLightSample(const Frame frame, inout PathState path, LightSample light, vec3 value) {
    if (!NOTES_LIGHT) return;
    path.isNoted = light.infinite && light.inversePdf > 0.0 && path.bounce <= GUIDE_VERTICES;
    if (!path.isNoted) return;
    const SurfacePoint lit = sideLit(path.surface, path.material, isBehind(path.surface, light.direction));
    const uint row = lightNoteRow(frame, path);
    STORE_ROW(lightNotes, row, uvec4(floatBitsToUint(litPoint(lit)), 0u));
    STORE_ROW(lightNotes, row + 1u, uvec4(floatBitsToUint(shadingNormal(lit)), 0u));
    STORE_ROW(lightNotes, row + 2u, floatBitsToUint(vec4(light.direction, luminanceOf(path.throughput * value))));
}

/// That sample's ray, of direction w, has met something.
void noteShadow(const Frame frame, PathState path, vec3 w) {
    if (!NOTES_LIGHT || !path.isNoted) return;
    STORE_ROW(lightNotes, lightNoteRow(frame, path) + 2u, uvec4(floatBitsToUint(w), 0u));
}
