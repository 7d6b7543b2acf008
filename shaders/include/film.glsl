// The film and the work list, row by row like the scene (fetch.glsl).
#include "shared/layer_types.h"

#ifdef FETCH_TEXEL
layout(set = 0, binding = BINDING_WORK_ITEMS, rgba32ui) uniform readonly uimageBuffer workRows;
layout(set = 0, binding = BINDING_PIXELS, rgba32ui) uniform uimageBuffer pixelRows;
#define STORE_ROW(name, i, value) imageStore(name, int(i), value)
#else
layout(set = 0, binding = BINDING_WORK_ITEMS, std430) readonly buffer WorkBuffer { uvec4 rows[]; }
workRows;
layout(set = 0, binding = BINDING_PIXELS, std430) buffer PixelBuffer { uvec4 rows[]; }
pixelRows;
#define STORE_ROW(name, i, value) name.rows[i] = value
#endif

/// What a kernel that sees adds up is behind a pixel's state.
const uint PIXEL_ROWS = SEES ? PIXEL_STATE_ROWS + SEEN_ROWS : PIXEL_STATE_ROWS;

WorkItem fetchWorkItem(uint index) {
    const uvec4 r = ROW(workRows, index);
    return WorkItem(r.x, r.y, r.z, r.w);
}

PixelState fetchPixel(uint index) {
    const uvec4 r0 = ROW(pixelRows, PIXEL_ROWS * index), r1 = ROW(pixelRows, PIXEL_ROWS * index + 1u);
    const uvec4 r2 = ROW(pixelRows, PIXEL_ROWS * index + 2u), r3 = ROW(pixelRows, PIXEL_ROWS * index + 3u);
    return PixelState(uintBitsToFloat(r0.xyz), r0.w, uintBitsToFloat(r1.xyz), r1.w,
                      uintBitsToFloat(r2.xyz), r2.w, uintBitsToFloat(r3.xyz), r3.w);
}

void storePixel(uint index, PixelState s) {
    STORE_ROW(pixelRows, PIXEL_ROWS * index, uvec4(floatBitsToUint(s.sum), s.count));
    STORE_ROW(pixelRows, PIXEL_ROWS * index + 1u, uvec4(floatBitsToUint(s.sumError), s.rejected));
    STORE_ROW(pixelRows, PIXEL_ROWS * index + 2u, uvec4(floatBitsToUint(s.m2), s.firstRejected));
    STORE_ROW(pixelRows, PIXEL_ROWS * index + 3u, uvec4(floatBitsToUint(s.m2Error), s.samplesBefore));
}

/// The sums behind a pixel's state, in a kernel that sees.
SeenPixel fetchSeen(uint index) {
    uint row = PIXEL_ROWS * index + PIXEL_STATE_ROWS;
    const uvec4 r0 = ROW(pixelRows, row), r1 = ROW(pixelRows, row + 1u);
    SeenPixel s;
    s.hits = r0.x;
    s.covered = uintBitsToFloat(r0.y);
    s.primitive = r0.z;
    s.placement = r0.w;
    s.b1 = uintBitsToFloat(r1.x);
    s.b2 = uintBitsToFloat(r1.y);
    row += SEEN_HEAD_ROWS;
#define FETCH_SUM(name, value, otherwise) s.name = uintBitsToFloat(ROW(pixelRows, row++));
    SEEN_SUMS(FETCH_SUM)
#undef FETCH_SUM
    return s;
}

void storeSeen(uint index, SeenPixel s) {
    uint row = PIXEL_ROWS * index + PIXEL_STATE_ROWS;
    STORE_ROW(pixelRows, row, uvec4(s.hits, floatBitsToUint(s.covered), s.primitive, s.placement));
    if (SEES_SURFACES) {
        STORE_ROW(pixelRows, row + 1u, uvec4(floatBitsToUint(vec2(s.b1, s.b2)), 0u, 0u));
        row += SEEN_HEAD_ROWS;
#define STORE_SUM(name, value, otherwise) STORE_ROW(pixelRows, row++, floatBitsToUint(s.name));
        SEEN_SUMS(STORE_SUM)
#undef STORE_SUM
    }
}
