// What tells surfaces apart, and weights by it.

DenoisePixel fetchPixel(uint index) {
    const vec4 r0 = ROW(pixelRows, 5u * index), r1 = ROW(pixelRows, 5u * index + 1u);
    const vec4 r2 = ROW(pixelRows, 5u * index + 2u), r3 = ROW(pixelRows, 5u * index + 3u);
    return DenoisePixel(r0.xyz, r0.w, r1.xyz, r1.w, r2.xyz, r2.w, r3.xyz, r3.w, 0.0, 0.0, 0.0, 0.0);
}

/// DenoisePixel::variance, which few need.
float fetchVariance(uint index) { return ROW(pixelRows, 5u * index + 4u).x; }

float squareOf(vec3 v) { return dot(v, v); }

/// Squared differences of two pixels, (dx, dy) apart: of albedo, of normals, and of depth relative to what the plane of
/// the first one has there.
vec3 featureDifferences(DenoisePixel p, DenoisePixel q, float dx, float dy) {
    const float depth = q.disparity - p.disparity - p.slopeX * dx - p.slopeY * dy;
    const float scale = max(p.disparity, q.disparity) + 1e-30; // no 0 / 0 where nothing is seen
    const float relative = depth / scale;
    return vec3(squareOf(q.albedo - p.albedo), squareOf(q.normal - p.normal), relative * relative);
}

#ifdef READS_PILOTS
DenoisePilot fetchPilot(uint index) {
    const vec4 r0 = ROW(pilotRows, 2u * index), r1 = ROW(pilotRows, 2u * index + 1u);
    return DenoisePilot(r0.xyz, r0.w, r1.xyz, r1.w);
}

/// By how much the squared difference of two pilots exceeds what their variances explain, of either half of the samples.
vec2 excess(DenoisePilot own, DenoisePilot other) {
    const float variance = own.variance + other.variance + 1e-30; // no 0 / 0 where there is no noise
    const vec3 even = other.mean - own.mean, odd = other.deviation - own.deviation;
    return max(vec2(squareOf(even + odd), squareOf(even - odd)) / variance - 1.0, 0.0);
}
#endif

/// exp(-x) for x from 0 on, to 2e-7 of itself; 0 from 87 on, where floats end. Of its own, so that it does not depend on
/// the driver: its precision may be anything (docs/theory/kernel.md, "Arithmetic"). 2^r by its Taylor series.
float expOfNegative(float x) {
    const float exponent = x * 1.44269504;
    const float whole = floor(exponent + 0.5);
    const float r = whole - exponent; // -0.5 to 0.5
    const float power =
        1.0 + r * (0.69314718 + r * (0.24022651 + r * (0.05550411 + r * (0.00961813 + r * (0.00133336 + r * 0.00015404)))));
    const int bits = (127 - int(min(whole, 126.0))) << 23;
    return x < 87.0 ? power * intBitsToFloat(bits) : 0.0;
}

/// What the squared error of a pixel's radiance over albedo counts for in relMSE, by channel: one over its square in
/// radiance, with the floor.
vec3 countOf(DenoisePixel p, vec3 radiance) {
    const vec3 albedo = max(p.albedo, vec3(DENOISE_LEAST_ALBEDO));
    const vec3 seen = radiance * albedo;
    return albedo * albedo / (seen * seen + dispatch.floor);
}
