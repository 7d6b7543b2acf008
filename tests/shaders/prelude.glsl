// What every test shader starts with: the shipped shader code as pathtrace.comp includes it, but
// for the path itself, and the loop over queries.
#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/texture_types.h"
#include "shared/guide_types.h"

#include "include/specialisation.glsl"
#include "include/fetch.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frame; };
layout(push_constant) uniform DispatchConstants { Dispatch dispatch; };

#include "include/given.glsl"
#include "include/numerics.glsl"
#include "include/random.glsl"
#include "include/intersect.glsl"
#include "include/traverse.glsl"
#include "include/camera.glsl"
#include "include/warps.glsl"
#include "include/conventions.glsl"
#include "include/surface.glsl"
#include "closures/bsdf.glsl"
#include "include/material_detail.glsl"
#include "include/relief.glsl"
#include "include/mixture.glsl"
#include "lights/lights.glsl"
#include "include/accumulate.glsl"

#include "queries.h"

/// Ends the constructor of a SurfacePoint that has no texture and is not placed.
#define NO_DETAIL , 0u, vec2(0.0), vec4(0.0), vec3(0.0, 0.0, 1.0), NO_PLACEMENT, NO_MIXTURE, 0u

#define BINDING_QUERIES BINDING_COUNT
#define BINDING_ANSWERS (BINDING_COUNT + 1)

/// A shader with one Query and one Answer per invocation; answer() follows.
#define QUERIES_AND_ANSWERS(Query, Answer)                                                         \
    layout(set = 0, binding = BINDING_QUERIES, std430) readonly buffer QueryBuffer {               \
        Query queries[];                                                                           \
    };                                                                                             \
    layout(set = 0, binding = BINDING_ANSWERS, std430) buffer AnswerBuffer { Answer answers[]; };  \
    Answer answer(Query q);                                                                        \
    void main() {                                                                                  \
        const uint index = gl_GlobalInvocationID.x;                                                \
        if (index < dispatch.itemCount) answers[index] = answer(queries[index]);                   \
    }
