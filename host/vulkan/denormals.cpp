#include "host/vulkan/denormals.hpp"

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace stromboli::vulkan {

namespace {

#if defined(__SSE__)

/// MXCSR: flush to zero (results), denormals are zero (operands).
constexpr uint64_t kDenormalsAreZero = 1u << 15 | 1u << 6;

uint64_t control() {
    return _mm_getcsr();
}
void setControl(uint64_t bits) {
    _mm_setcsr(uint32_t(bits));
}

#elif defined(__aarch64__)

/// FPCR: FZ, of operands and results.
constexpr uint64_t kDenormalsAreZero = 1u << 24;

uint64_t control() {
    uint64_t bits;
    asm volatile("mrs %0, fpcr" : "=r"(bits));
    return bits;
}
void setControl(uint64_t bits) {
    asm volatile("msr fpcr, %0" : : "r"(bits));
}

#else

constexpr uint64_t kDenormalsAreZero = 0;

uint64_t control() {
    return 0;
}
void setControl(uint64_t) {}

#endif

} // namespace

DenormalsAreZero::DenormalsAreZero() : before_(control()) {
    setControl(before_ | kDenormalsAreZero);
}

DenormalsAreZero::~DenormalsAreZero() {
    setControl(before_);
}

} // namespace stromboli::vulkan
