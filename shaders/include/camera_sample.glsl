// The camera ray of a sample.

/// at: column and row of the pixel; pixel_: its number in the whole picture; u: for the place in and about it.
/// weight: that of the sample, by the pixel's filter.
CameraRay cameraRayOfSample(const Given given, uvec2 at, uint pixel_, uint sample_, vec2 u, out float weight) {
    vec2 onLens = vec2(0.0);
    if (HAS_LENS)
        onLens = sampleDisk(unitFloats(randomWords(pixel_, sample_, LENS_BLOCK, given.frame.seed)).xy);
    return cameraRay(given.frame, given.grid, vec2(ivec2(at)) + placeInPixel(u, weight), onLens);
}
