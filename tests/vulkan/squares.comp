#version 460
// The smallest pipeline with a specialisation constant: squares of numbers, times a factor.
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FACTOR = 1u;
layout(binding = 0) buffer Numbers { uint numbers[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    numbers[i] = numbers[i] * numbers[i] * FACTOR;
}
