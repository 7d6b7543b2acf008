#include "host/core/pages.hpp"

#include <cstdint>
#include <ctime>
#include <sys/mman.h>

namespace stromboli {

namespace {

/// The size of huge pages on x86-64, and on AArch64 with base pages of 4 KiB. Elsewhere the system
/// does nothing or more.
constexpr uintptr_t kHugePage = uintptr_t(2) << 20;

/// The whole huge pages within memory.
std::span<std::byte> hugePagesIn(std::span<std::byte> memory) {
    const auto begin = reinterpret_cast<uintptr_t>(memory.data());
    const uintptr_t first = (begin + kHugePage - 1) / kHugePage * kHugePage;
    const uintptr_t last = (begin + memory.size()) / kHugePage * kHugePage;
    if (first >= last) return {};
    return memory.subspan(first - begin, last - first);
}

void advise(std::span<std::byte> memory, int advice) {
    if (!memory.empty()) ::madvise(memory.data(), memory.size(), advice);
}

/// CPU seconds of this thread, and of the system on its behalf. Other processes do not count.
double cpuSeconds() {
    timespec t = {};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// CPU seconds of the first writes to memory, one in each `step` bytes.
double secondsToTake(std::span<std::byte> memory, size_t step) {
    const double start = cpuSeconds();
    for (size_t i = 0; i < memory.size(); i += step)
        *const_cast<volatile std::byte*>(&memory[i]) = std::byte(0);
    return cpuSeconds() - start;
}

} // namespace

void preferHugePages(std::span<std::byte> memory) {
    advise(hugePagesIn(memory), MADV_HUGEPAGE);
}

void takeHugePages(std::span<std::byte> memory) {
    std::span<std::byte> left = hugePagesIn(memory);
    advise(left, MADV_HUGEPAGE);
    const double small = double(kHugePage / kPageBytes) * secondsOfASmallPage();
    while (!left.empty()) {
        const double seconds = secondsToTake(left.first(kHugePage), kHugePage);
        left = left.subspan(kHugePage);
        if (seconds > small) return advise(left, MADV_NOHUGEPAGE);
    }
}

double secondsOfASmallPage() {
    static const double seconds = [] {
        constexpr size_t kPages = 64, kBytes = kPages * kPageBytes;
        void* const memory =
            ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (memory == MAP_FAILED) return 0.0;
        const double all = secondsToTake({static_cast<std::byte*>(memory), kBytes}, kPageBytes);
        ::munmap(memory, kBytes);
        return all / double(kPages);
    }();
    return seconds;
}

} // namespace stromboli
