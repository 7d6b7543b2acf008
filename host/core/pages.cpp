#include "host/core/pages.hpp"

#include <cstdint>
#include <sys/mman.h>

namespace stromboli {

namespace {

/// The size of huge pages on x86-64, and on AArch64 with base pages of 4 KiB. Elsewhere the system
/// does nothing or more.
constexpr uintptr_t kHugePage = uintptr_t(2) << 20;

} // namespace

void preferHugePages(std::span<std::byte> memory) {
    const auto begin = reinterpret_cast<uintptr_t>(memory.data());
    const uintptr_t first = (begin + kHugePage - 1) / kHugePage * kHugePage;
    const uintptr_t last = (begin + memory.size()) / kHugePage * kHugePage;
    if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

} // namespace stromboli
