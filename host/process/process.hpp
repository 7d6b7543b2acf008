#pragma once

#include <cstdint>

namespace stromboli::process {

// What belongs to a process as a whole. Programs call these functions, from main(): a library that
// did so would change its user's process. cmake/CheckLayers.cmake sees to it that nothing else in
// host/ or scene/ sets an environment variable, an allocator's option or a signal handler, apart
// from the command line.

/// Has lavapipe run 16 lanes at a time on processors with AVX-512, where Mesa up to 22.3 takes
/// 8 unless the environment variable LP_NATIVE_VECTOR_WIDTH asks for more. If the user has set
/// that, nothing is done. No other driver reads it. To be called before the first device is opened,
/// and while there is one thread only.
void useWideVectors();

/// Has lavapipe work on so many threads. To be called as useWideVectors() is.
void useDriverThreads(uint32_t threads);

/// Has the Vulkan loader leave out Mesa's drivers for GPUs where the system shows no GPU
/// (/dev/dri): opening them takes a twentieth of the CPU time of a short render. Nothing is done if
/// the user has told the loader, or such a driver, what to do. To be called as useWideVectors() is.
void leaveOutDriversOfAbsentGpus();

/// Memory that is freed is kept for what is asked for next, by whatever thread: between two passes
/// the plan takes and frees many times the picture, and the driver compiles kernels on a thread of
/// its own, which would ask thousands of times. It comes from the system in pages of 2 MiB where
/// small ones, which are asked for one at a time, take long: a fifth of a start's CPU time in some
/// virtual machines. To be called before much is allocated.
void useMemoryInLargePieces();

} // namespace stromboli::process
