// The denoiser's buffers, read and written row by row (16 bytes) through one kind of memory, chosen when the shader is
// compiled: storage texel buffers (FETCH_TEXEL) or storage buffers (docs/theory/kernel.md, "Fetch").

#ifdef FETCH_TEXEL
#define ROWS_TO_READ(binding_, name) layout(set = 0, binding = binding_, rgba32ui) uniform readonly uimageBuffer name;
#define ROWS_TO_WRITE(binding_, name) layout(set = 0, binding = binding_, rgba32ui) uniform writeonly uimageBuffer name;
#define ROW(name, i) uintBitsToFloat(imageLoad(name, int(i)))
#define WRITE_ROW(name, i, row) imageStore(name, int(i), floatBitsToUint(row))
#else
#define ROWS_TO_READ(binding_, name)                                                                \
    layout(set = 0, binding = binding_, std430) readonly buffer name##Buffer { uvec4 rows[]; }      \
    name;
#define ROWS_TO_WRITE(binding_, name)                                                               \
    layout(set = 0, binding = binding_, std430) writeonly buffer name##Buffer { uvec4 rows[]; }     \
    name;
#define ROW(name, i) uintBitsToFloat(name.rows[i])
#define WRITE_ROW(name, i, row) name.rows[i] = floatBitsToUint(row)
#endif

layout(push_constant) uniform DispatchConstants { DenoiseDispatch dispatch; };
layout(local_size_x = DENOISE_GROUP_SIZE) in;

/// The pixel of this invocation.
struct Place {
    int x, y;      ///< in the picture
    uint index;    ///< in buffers
    bool isNeeded; ///< else there are more invocations than pixels
};

Place placeOfInvocation() {
    const uint number = gl_GlobalInvocationID.x;
    const uint row = number / dispatch.width;
    const uint y = dispatch.firstRow + row;
    return Place(int(number - row * dispatch.width), int(y), (y - dispatch.topRow) * dispatch.width + number - row * dispatch.width,
                 row < dispatch.rowCount);
}

bool isInPicture(int x, int y) { return x >= 0 && y >= 0 && x < int(dispatch.width) && y < int(dispatch.height); }

uint indexBeside(Place place, int dx, int dy) { return uint(int(place.index) + dy * int(dispatch.width) + dx); }
