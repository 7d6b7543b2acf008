// Random numbers that choices are made by.
//
// A choice uses up digits of a random number, and 24 of them do not last for a tree whose branches may
// differ a millionfold. So the number is an integer of 31 bits; the share of a branch is a multiple of
// 2^-31, at least one, so that the probability is stated exactly; and the digits that a choice has used up
// are filled again, from a hash of the number itself and of its companion.

struct ChoiceNumber {
    uint value; ///< uniform in [0, 2^31)
    uint digits; ///< state that new digits are made from
};

/// New digits (a variant of lowbias32, C. Wellons 2018): 32 bits.
uint newDigits(inout ChoiceNumber c) {
    c.digits = c.digits * 747796405u + 2891336453u;
    uint x = c.digits;
    x = (x ^ x >> 16u) * 0x7FEB352Du;
    x = (x ^ x >> 15u) * 0x846CA68Bu;
    return x ^ x >> 16u;
}

/// A choice number made of u.x, a multiple of 2^-24.
ChoiceNumber choiceNumber(vec2 u) {
    ChoiceNumber c;
    c.digits = floatBitsToUint(u.x) * 0x9E3779B1u ^ floatBitsToUint(u.y) * 0x85EBCA6Bu;
    c.value = uint(int(u.x * 16777216.0)) << 7u | newDigits(c) >> 25u;
    return c;
}

/// What is left as a number in [0, 1), a multiple of 2^-24.
float restOf(ChoiceNumber c) { return float(int(c.value >> 7u)) * (1.0 / 16777216.0); }

/// Chooses, and leaves a number that is uniform again. ofFirst: how many of the 2^31 values choose the first.
bool choosesFirst(inout ChoiceNumber c, uint ofFirst) {
    const bool first = c.value < ofFirst;
    const uint width = first ? ofFirst : 0x80000000u - ofFirst;
    const uint offset = first ? c.value : c.value - ofFirst;
    const uint digits = newDigits(c);
    const float within = float(int(digits >> 8u)) * (1.0 / 16777216.0);
    const float u = min((float(int(offset)) + within) / float(width), 1.0 - UNIT_ROUNDOFF);
    c.value = uint(int(u * 16777216.0)) << 7u | digits & 0x7Fu;
    return first;
}

/// A column of an alias table of `count`; fraction: where in it, in 2^-32, by new digits too where the number has too
/// few.
uint pickColumn(inout ChoiceNumber c, uint count, out uint fraction) {
    uint index, within, carry, unused;
    umulExtended(c.value << 1u, count, index, fraction);
    // The number is a multiple of 2^-31: what is between two of them comes from new digits.
    umulExtended(newDigits(c), 2u * count, within, unused);
    fraction = uaddCarry(fraction, within, carry);
    return index + carry;
}

/// Whether the fraction of a column chooses its alias. rest: what is left of the fraction, in [0, 1), with new digits: a
/// threshold may be as small as 2^-31, in which steps the choice is made.
bool choosesAlias(inout ChoiceNumber c, uint fraction, float threshold, out float rest) {
    const uint part = fraction >> 1u, bound = uint(threshold * 2147483648.0);
    const bool alias = part >= bound;
    const uint within = alias ? part - bound : part, width = alias ? 0x80000000u - bound : bound;
    const float digits = float(int(newDigits(c) >> 8u)) * (1.0 / 16777216.0);
    rest = clamp((float(int(within)) + digits) / max(float(width), 1.0), 0.0, 1.0 - UNIT_ROUNDOFF);
    return alias;
}
