#include "host/vulkan/vector_width.hpp"

#include <cstdlib>

namespace stromboli::vulkan {
namespace {

/// What LLVM needs so that 512-bit vectors of 8- to 64-bit numbers and their masks are single
/// registers (x86-64-v4). Without, it takes two registers for each, which doubles the kernel's
/// code.
bool processorHasAvx512() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

} // namespace

void useWideVectors() {
    if (processorHasAvx512()) ::setenv("LP_NATIVE_VECTOR_WIDTH", "512", 0 /* keep the user's */);
}

} // namespace stromboli::vulkan
