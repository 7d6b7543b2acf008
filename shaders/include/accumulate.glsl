// Statistics of one pixel's samples.

/// Largest radiance a sample may have: 2^48. Its square, summed 2^31 times, is still finite.
const float LARGEST_RADIANCE = 281474976710656.0;

/// Adds one sample: compensated sums, Welford's update for the squares. A sample that is
/// not finite, negative or absurdly large is counted and left out, so that it cannot spoil its
/// pixel: as unsigned integers, the patterns of all of these are above that of the largest allowed.
/// (So is that of -0, which no sum that begins with 0 comes to.) weight: by the pixel's filter, where samples have
/// weights.
void addSample(inout PixelState state, vec3 radiance, float weight) {
    const uvec3 bits = floatBitsToUint(radiance);
    if (max(bits.x, max(bits.y, bits.z)) > floatBitsToUint(LARGEST_RADIANCE)) {
        if (state.rejected == 0u) state.firstRejected = state.count;
        ++state.rejected;
        return;
    }
    if (samplesHaveWeights()) radiance *= weight;
    const float before = float(state.count);
    // Divided, not multiplied by a reciprocal: equal samples have no deviation.
    const vec3 mean = (state.sum + state.sumError) / max(before, 1.0);
    const vec3 deviation = radiance - mean;
    // Welford's (x - mean before)(x - mean after), in the form that no rounding makes negative.
    addCompensated(state.m2, state.m2Error, deviation * deviation * (before / (before + 1.0)));
    addCompensated(state.sum, state.sumError, radiance);
    ++state.count;
}
