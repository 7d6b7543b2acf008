#version 460
// The kernel's random numbers, for given counters: what a driver makes of integer arithmetic.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Counters { uvec4 counters[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Numbers { vec4 numbers[]; };
layout(push_constant) uniform Constants { uint count; };

#include "shared/interface.h"
const uint SAMPLER = SAMPLER_INDEPENDENT; // the hash that all samplers rest on
#include "include/random.glsl"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    const uvec4 c = counters[i];
    words[i] = pcg4d(c);
    numbers[i] = randomBlock(c.x, c.y, c.z, c.w);
}
