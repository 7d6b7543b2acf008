#version 460
// How many words each scheduler keeps of a path.
#extension GL_GOOGLE_include_directive : require

#include "include/path_kernel.glsl"
#include "shared/path_fields.h"
#define KEPT KEPT_BETWEEN_DISPATCHES
#include "include/path_memory.glsl"

void main() {
    if (gl_GlobalInvocationID.x != 0u) return;
    pathWords[0] = wordsOfPath(KEPT);
    pathWords[1] = wordsOfPath(ALWAYS);
}
