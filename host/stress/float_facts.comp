#version 460
// What a driver makes of arithmetic with floats, for given pairs: bits in, bits out.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Pairs { uvec2 pairs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Results { uvec4 results[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Comparisons { uint comparisons[]; };
layout(push_constant) uniform Constants { uint count; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    const float a = uintBitsToFloat(pairs[i].x), b = uintBitsToFloat(pairs[i].y);
    precise float sum = a + b, difference = a - b, product = a * b, negated = -a;
    results[i] = floatBitsToUint(vec4(sum, difference, product, negated));
    // In the order of FloatFacts::comparisons (case.hpp).
    comparisons[i] = uint(a < b) | uint(a <= b) << 1 | uint(a > b) << 2 | uint(a >= b) << 3 |
                     uint(a == b) << 4 | uint(a != b) << 5 | uint(!(a < b)) << 6;
}
