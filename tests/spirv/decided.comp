#version 460
// Every form of branch and value that the specialiser decides: ifs, switches and loops that constants end,
// values that follow from constants, variables and members that nobody reads.
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint TIMES = 3u;
layout(constant_id = 2) const int SIGNED = -7;
layout(constant_id = 3) const bool ASKED = false;
layout(constant_id = 4) const uint KIND = 2u;
layout(constant_id = 5) const float SCALE = 1.5;
layout(set = 0, binding = 0, std430) buffer Answers { uint answers[]; };

struct Pair {
    uint first;
    vec3 second;
};
struct Nest {
    Pair inner;
    float never; ///< is written and not read
};

const uint TWICE = 2u * TIMES + 1u;
uint counter;
Nest kept;

uint ofSwitch(uint x) {
    switch (KIND) {
    case 0u: return x + 1u;
    case 1u:
    case 2u:
        if (x > 3u) return x * 5u;
        x += 100u;
        break;
    default: return x ^ 0xFFu;
    }
    return x + 7u;
}

uint ofLoops(uint x) {
    uint sum = 0u;
    for (uint i = 0u; i < TIMES; ++i) {
        if (ASKED && i == 1u) continue;
        if (sum > 1000u) break;
        sum += x + i;
    }
    do {
        ++sum;
        if (x == 5u) break;
        sum *= 2u;
    } while (ASKED && sum < 100u);
    while (ASKED && sum < 500u) {
        sum += 13u;
        if (sum % 7u == 3u) break;
    }
    return sum;
}

uint ofConstants(uint x) {
    uint result = (TIMES & 4u) != 0u ? x : ~x;
    result += uint(SIGNED >> 1) + uint(SIGNED < 0 ? 1 : 0) + (TWICE << 2u) + (TWICE % 5u) + TWICE / 3u;
    result ^= ASKED ? 0u : x * TIMES;
    return result | (KIND == 7u ? x : 0u);
}

uint ofMembers(uint x) {
    Nest n = Nest(Pair(x, vec3(float(x) * SCALE, 1.0, 2.0)), 4.0);
    n.inner.first += 3u;
    n.inner.second.y += float(n.inner.first);
    kept = n;
    if (ASKED) kept.inner.second = kept.inner.second.zyx;
    kept.never = kept.inner.second.x;
    const Pair copy = kept.inner;
    return floatBitsToUint(copy.second.x + copy.second.y) ^ copy.first;
}

void main() {
    const uint x = gl_GlobalInvocationID.x;
    counter = 0u;
    if (ASKED && x > 2u) ++counter;
    answers[4u * x] = ofSwitch(x) + counter;
    answers[4u * x + 1u] = ofLoops(x);
    answers[4u * x + 2u] = ofConstants(x);
    answers[4u * x + 3u] = ofMembers(x);
}
