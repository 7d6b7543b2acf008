#version 460
// Sums moments over the width of the window; blend.comp sums these over its height.
#extension GL_GOOGLE_include_directive : require

#include "shared/denoise_types.h"
#include "denoise/rows.glsl"
ROWS_TO_READ(DENOISE_BINDING_MOMENTS, momentRows)
ROWS_TO_WRITE(DENOISE_BINDING_SUMS, sumRows)

void main() {
    const Place place = placeOfInvocation();
    if (place.isNeeded) {
        vec4 s0 = vec4(0.0), s1 = vec4(0.0), s2 = vec4(0.0);
        for (int dx = -DENOISE_WINDOW_REACH; dx <= DENOISE_WINDOW_REACH; ++dx) {
            const bool isThere = isInPicture(place.x + dx, place.y);
            const uint row = 3u * (isThere ? indexBeside(place, dx, 0) : place.index);
            const float times = isThere ? 1.0 : 0.0;
            s0 += times * ROW(momentRows, row);
            s1 += times * ROW(momentRows, row + 1u);
            s2 += times * ROW(momentRows, row + 2u);
        }
        WRITE_ROW(sumRows, 3u * place.index, s0);
        WRITE_ROW(sumRows, 3u * place.index + 1u, s1);
        WRITE_ROW(sumRows, 3u * place.index + 2u, s2);
    }
}
