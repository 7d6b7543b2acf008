// Whether a ray passes a surface that is partly there.

/// Not those of randomWords(): its words are numbered by pixel, sample, block and seed alone.
const uint PASS_SEED = 0x9E3779B9u;

/// In [0, 1), for whether the ray that has hit something passes it: of the ray's first block of random numbers and of
/// what was hit where, so that it neither depends on what was passed before nor on how often a ray is begun.
/// purpose: 0; of a mixture at the same hit, the number of the choice, from 1.
float passNumber(uint seed, Traversal t, uint pixel_, uint sample_, uint block, uint purpose) {
    const uvec4 words = pcg4d(uvec4(pixel_, sample_, block, seed ^ PASS_SEED));
    uvec4 there = uvec4(t.hitPrimitive, floatBitsToUint(t.tMax), purpose, 0u);
    there.w = t.hitPlacement;
    return unitFloats(pcg4d(words ^ there)).x;
}

/// The ray goes on behind what it has hit, to its own end.
void passOn(inout Traversal t, float end) {
    t.tMin = t.tMax;
    t.passed = t.hitPrimitive;
    t.passedPlacement = t.hitPlacement;
    t.tMax = end;
}
