// Whether a ray passes a surface that is partly there.

/// Not those of randomWords(): its words are numbered by pixel, sample, block and seed alone.
const uint PASS_SEED = 0x9E3779B9u;

/// What the numbers at a hit are made of: the ray's first block of random numbers and what was hit where, so that they
/// neither depend on what was passed before nor on how often a ray is begun.
uvec4 hitWords(uint seed, Traversal t, uint pixel_, uint sample_, uint block) {
    const uvec4 words = pcg4d(uvec4(pixel_, sample_, block, seed ^ PASS_SEED));
    return words ^ uvec4(t.hitPrimitive, floatBitsToUint(t.tMax), 0u, t.hitPlacement);
}

/// In [0, 1), for whether the ray passes what it has hit (purpose 0), or, from 1 on, for each choice between the two
/// materials of a mixture there.
float hitNumber(uvec4 words, uint purpose) {
    words.z ^= purpose;
    return unitFloats(pcg4d(words)).x;
}

/// The ray goes on behind what it has hit, to its own end.
void passOn(inout Traversal t, float end) {
    t.tMin = t.tMax;
    t.passed = t.hitPrimitive;
    t.passedPlacement = t.hitPlacement;
    t.tMax = end;
}
