#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stromboli::bench {

/// A kernel compiled once more with plain code in the place of robust code (host/bench/plain), to
/// see what robustness costs. Its pictures have the faults that go with it.
struct PlainKernel {
    std::string name; ///< what is plain
    std::span<const uint32_t> texel, storage;

    std::span<const uint32_t> code(bool texelFetch) const { return texelFetch ? texel : storage; }
};

/// Forms of shaders/trace_rays.comp: triangles by Moeller and Trumbore, boxes without slack.
std::vector<PlainKernel> plainRayKernels();

/// Forms of shaders/pathtrace.comp: rays that start 1e-4 off surfaces, no shadow terminator, all
/// that is plain at once.
std::vector<PlainKernel> plainPathKernels();

} // namespace stromboli::bench
