// Sobol's sequence in four dimensions, shuffled and scrambled for each use (Burley, "Practical
// Hash-based Owen Scrambling", JCGT 2020). Everything works on numbers whose bits are reversed: the
// lowest bit is the first digit. There a scrambling in which each digit depends on those before it
// (Owen 1995) is made of additions and multiplications, whose carries go up.

/// Nested uniform scrambling of a reversed number (Laine and Karras 2011, with Vegdahl's constants
/// of 2021): a bijection in which bit i of the result depends on bits 0 to i only.
uint scrambleReversed(uint x, uint key) {
    x ^= x * 0x3D20ADEAu;
    x += key;
    x *= (key >> 16u) | 1u;
    x ^= x * 0x05526C56u;
    return x ^ (x * 0x53A22864u);
}

/// Bits of a sample's number that the sequence uses; the rest begins another one.
const uint SOBOL_INDEX_BITS = 24u;
const uint SOBOL_INDEX_MASK = 0xFFFFFFu;

// Dimensions of Sobol's sequence, reversed, for the direction numbers of Joe and Kuo (2008). The
// first dimension is the index itself. The others multiply its bits with a triangular matrix over
// GF(2): as a product of sparse factors, one for each halving of the matrix, whose diagonals are the
// shifts and masks here (docs/theory/estimator.md; a test compares them with the direction numbers).

/// x + 1: Pascal's triangle.
uint sobolReversed1(uint y) {
    y ^= y >> 16u;
    y ^= (y & 0xFF00FF00u) >> 8u;
    y ^= (y & 0xF0F0F0F0u) >> 4u;
    y ^= (y & 0xCCCCCCCCu) >> 2u;
    return y ^ ((y & 0xAAAAAAAAu) >> 1u);
}

/// x^2 + x + 1.
uint sobolReversed2(uint y) {
    y ^= ((y & 0xFF0000u) >> 8u) ^ (y >> 16u);
    y ^= ((y & 0xF00u) >> 4u) ^ ((y & 0xF00u) >> 8u) ^ ((y & 0xF000u) >> 12u);
    y ^= ((y & 0x303030u) >> 2u) ^ ((y & 0x30C030u) >> 4u) ^ ((y & 0xC0C0C0u) >> 6u);
    y ^= ((y & 0x444444u) >> 1u) ^ ((y & 0x848484u) >> 2u) ^ ((y & 0x888888u) >> 3u);
    return y ^ ((y & 0x222222u) >> 1u);
}

/// x^3 + x + 1.
uint sobolReversed3(uint y) {
    y ^= ((y & 0x0FF000u) >> 8u) ^ ((y & 0xFFF000u) >> 12u) ^ ((y & 0xF00000u) >> 16u) ^ (y >> 20u);
    y ^= ((y & 0x3C03C0u) >> 4u) ^ ((y & 0xFC0FC0u) >> 6u) ^ ((y & 0x300C00u) >> 8u) ^
         ((y & 0xC00C00u) >> 10u);
    y ^= ((y & 0x618618u) >> 2u) ^ ((y & 0xE38E38u) >> 3u) ^ ((y & 0x420420u) >> 4u) ^
         ((y & 0x820820u) >> 5u);
    return y ^ ((y & 0x492492u) >> 1u) ^ ((y & 0x820820u) >> 2u);
}

/// Four numbers in [0, 1), as words: point number sampleIndex of a sequence of its own for each
/// pixel, block and seed. Its points are those of Sobol's sequence in another order, in which every
/// 2^k points that begin at a multiple of 2^k still are 2^k such points of that sequence.
uvec4 sobolWords(uint pixel, uint sampleIndex, uint block, uint seed) {
    const uvec4 key = pcg4d(uvec4(pixel, sampleIndex >> SOBOL_INDEX_BITS, block, seed));
    const uint index = bitfieldReverse(scrambleReversed(bitfieldReverse(sampleIndex), key.x + key.z)) &
                       SOBOL_INDEX_MASK;
    return bitfieldReverse(uvec4(scrambleReversed(index, key.x),
                                 scrambleReversed(sobolReversed1(index), key.y),
                                 scrambleReversed(sobolReversed2(index), key.z),
                                 scrambleReversed(sobolReversed3(index), key.w)));
}
