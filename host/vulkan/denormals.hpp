#pragma once

#include <cstdint>

namespace stromboli::vulkan {

/// While it lives, floats of the calling thread below the least normal one, 2^-126, count as 0, as
/// operands and as results; then what the thread had before is set again. Threads that the calling
/// one starts meanwhile keep it.
///
/// Drivers of CPUs start the threads that run kernels while a device is opened. They run both sides
/// of every branch, and so read small integers as floats, which are denormal: each such operation
/// takes an Intel processor some 150 cycles. Nothing counts on denormals (docs/hard_cases.md),
/// and Vulkan lets a device have none.
///
/// On x86-64 and AArch64; elsewhere it does nothing.
class DenormalsAreZero {
  public:
    DenormalsAreZero();
    ~DenormalsAreZero();
    DenormalsAreZero(const DenormalsAreZero&) = delete;
    DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

  private:
    uint64_t before_; ///< the thread's control register of floating-point arithmetic
};

} // namespace stromboli::vulkan
