// Where in and about its pixel a sample falls: in proportion to the pixel's filter, so that all samples weigh the
// same (filter importance sampling; Ernst, Stamminger and Greiner 2006). Of a filter that is negative in places, in
// proportion to its absolute value: there samples have weights, whose mean is 1.

/// Integral of the four-term Blackman-Harris window (Harris 1978) from its left end to t in [0, 1], over the whole
/// integral, and its derivative.
vec2 blackmanHarrisIntegral(float t) {
    const vec3 over = vec3(0.48829, -0.14128, 0.01168) / 0.35875;
    const vec2 w = cosSin(4.0 * t); // of 2 pi t; multiples follow from it
    const float c2 = 2.0 * w.x * w.x - 1.0, s2 = 2.0 * w.x * w.y;
    const vec3 cosine = vec3(w.x, c2, 2.0 * w.x * c2 - w.x);
    const vec3 sine = vec3(w.y, s2, 2.0 * w.x * s2 - w.y);
    return vec2(t - dot(over, sine * vec3(1.0, 0.5, 1.0 / 3.0)) * (0.5 * INV_PI), 1.0 - dot(over, cosine));
}

/// Newton's method from the middle never steps past the answer, since the integral bends one way on either side;
/// the derivative is nowhere below 1.6e-4. Ten steps bring the integral to within 5e-8 of u, for all but the last
/// 5e-5 of u at either end.
float sampleBlackmanHarris(float u) {
    float t = 0.5;
    for (uint i = 0u; i < 10u; ++i) {
        const vec2 f = blackmanHarrisIntegral(t);
        t = clamp(t + (u - f.x) / f.y, 0.0, 1.0);
    }
    return t;
}

/// By Box and Muller's transform, cut off at a radius.
vec2 sampleGaussian(vec2 u) {
    const float inDeviations = GAUSSIAN_RADIUS / GAUSSIAN_DEVIATION;
    const float within = 1.0 - exp(-0.5 * inDeviations * inDeviations);
    return GAUSSIAN_DEVIATION * sqrt(max(-2.0 * log(1.0 - u.x * within), 0.0)) * cosSin(4.0 * u.y);
}

/// The sum of two uniform numbers is distributed like a tent; of one the integral is inverted. In [-1, 1].
vec2 sampleTent(vec2 u) {
    const vec2 below = sqrt(2.0 * u) - 1.0, above = 1.0 - sqrt(2.0 - 2.0 * u);
    return mix(above, below, lessThan(u, vec2(0.5)));
}

/// From the pixel's middle, along columns or rows. weight: the other direction's is multiplied by it.
float sampleFilterTable(float u, inout float weight) {
    const float at = u * float(FILTER_CELLS);
    const int cell = min(int(at), int(FILTER_CELLS) - 1);
    const vec4 row = uintBitsToFloat(ROW(filterRows, uint(cell)));
    weight *= row.z;
    return row.x + (at - float(cell)) * row.y;
}

/// From the pixel's upper left corner, in pixels. weight: that of the sample.
vec2 placeInPixel(vec2 u, out float weight) {
    weight = 1.0;
    if (PIXEL_FILTER == FILTER_GAUSSIAN) return 0.5 + (1.0 + FILTER_EXTRA) * sampleGaussian(u);
    if (PIXEL_FILTER == FILTER_TENT) return 0.5 + (1.0 + FILTER_EXTRA) * sampleTent(u);
    if (PIXEL_FILTER == FILTER_TABLE)
        return 0.5 + vec2(sampleFilterTable(u.x, weight), sampleFilterTable(u.y, weight));
    if (PIXEL_FILTER == FILTER_BLACKMAN_HARRIS)
        return 0.5 + BLACKMAN_HARRIS_RADIUS * (2.0 * vec2(sampleBlackmanHarris(u.x), sampleBlackmanHarris(u.y)) - 1.0);
    return u;
}
