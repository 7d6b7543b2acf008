#include "host/process/process.hpp"

#include <cstdlib>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace stromboli::process {
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

void useDriverThreads(uint32_t threads) {
    ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

void keepFreedMemory() {
#ifdef __GLIBC__
    constexpr int kKept = 256 << 20; // bytes: the plan of a picture of two million pixels
    ::mallopt(M_TRIM_THRESHOLD, kKept);
    ::mallopt(M_MMAP_THRESHOLD, kKept);
#endif
}

} // namespace stromboli::process
