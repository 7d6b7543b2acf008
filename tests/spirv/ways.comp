#version 460
// Ways through functions that the specialiser straightens: early returns, loops that go by a number of times, and values
// that are stored and loaded again.
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint TIMES = 3u;
layout(constant_id = 2) const bool RETURNS_EARLY = true;
layout(set = 0, binding = 0, std430) buffer Answers { uint answers[]; };

uint ofOneReturn(uint x) {
    uint y = x * 7u;
    if (RETURNS_EARLY && (x & 1u) != 0u) return y ^ 5u;
    y += 3u;
    if ((y & 4u) != 0u) y *= 5u;
    return y;
}

uint ofManyReturns(uint x) {
    if (RETURNS_EARLY && x == 2u) return 11u;
    uint y = x + 1u;
    if (x > 9u) {
        y *= 3u;
        return y;
    } else if (x > 7u) {
        return y + ofOneReturn(y);
    }
    if (y > 4u) {
        if (RETURNS_EARLY && x == 6u) return 13u; // what follows this selection is passed by some
        y += 17u;
    }
    if (x == 3u) return ofOneReturn(y); else return y ^ 0x55u;
}

uint ofReturnsInLoops(uint x) {
    uint sum = 0u;
    for (uint i = 0u; i < TIMES; ++i) {
        sum += ofOneReturn(x + i);
        if (RETURNS_EARLY && sum > 60u) return sum;
    }
    return sum + 1u;
}

uint ofCountedLoops(uint x) {
    uint kept[5];
    for (uint i = 0u; i + 1u < 6u; ++i)
        kept[i] = x * i;
    uint sum = 0u;
    for (int down = 4; down >= 0; down -= 2) {
        sum = sum * 3u + kept[down];
        for (uint once = 7u; once < 8u; ++once)
            for (uint k = 0u; k < 3u; ++k)
                sum ^= kept[k] + once;
    }
    for (uint k = 0u; k < 3u; ++k) {
        if (k == 1u) continue;
        sum += kept[k];
    }
    precise float exact = float(x);
    for (uint i = 0u; i < 3u; ++i)
        exact = exact * 1.25 + 0.375; // a copy for each time, none of which may be fused
    sum += uint(exact);
    uint after = 0u;
    for (uint i = 0u; i < 3u; ++i, after += i) // read once more behind its step
        sum += i * after;
    sum ^= after;
    for (uint i = 0u; i < 0u; ++i)
        sum = 0u;
    for (uint i = 0u; i < TIMES; ++i) {
        if (sum > 5000u) break; // is not left by its test alone
        sum += i;
    }
    uint j = 0u;
    for (uint i = 0u; i < 4u; ++i)
        if ((sum & 1u) != 0u) j += i; // counts something else
    return sum + j;
}

uint ofStoredValues(uint x) {
    uint once = x * 9u, last = 0u, never = 1u;
    for (uint i = 0u; i < TIMES + x; ++i) {
        const uint now = i * i + once; // another one in each iteration
        if (i == 1u) last = now;       // the only store but for that of 0
        never += last ^ now;
    }
    uint twice = never;
    twice = twice + once; // the store before is read by this one alone
    vec3 parts = vec3(float(x));
    parts.y += 1.0;
    const vec3 whole = parts;
    parts = whole.zyx;
    return twice + uint(parts.y) + uint(whole.x);
}

void main() {
    const uint x = gl_GlobalInvocationID.x;
    answers[4u * x] = ofManyReturns(x);
    answers[4u * x + 1u] = ofReturnsInLoops(x);
    answers[4u * x + 2u] = ofCountedLoops(x);
    answers[4u * x + 3u] = ofStoredValues(x);
}
