#version 460
// Products of two floats, as bits: what a device makes of denormals.
layout(local_size_x = 64) in;
layout(binding = 0) buffer Numbers { uint numbers[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    numbers[i] = floatBitsToUint(uintBitsToFloat(numbers[i]) * uintBitsToFloat(numbers[i + 64u]));
}
