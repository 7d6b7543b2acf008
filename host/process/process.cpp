#include "host/process/process.hpp"

#include "host/core/pages.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
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

/// Whether the lavapipe in the loader's usual places is one that was tried with 16 lanes:
/// Mesa 22.3, which states a Vulkan whose third number, that of the headers, is 230. Mesa 25.0
/// (305; Debian 13) computes the same bytes with them, but takes a hundred times as long, or for
/// ever.
bool lavapipeIsRightWith16Lanes() {
    for (const char* folder :
         {"/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"}) {
        std::error_code failed; // a folder that is not there has no drivers
        for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
            if (!entry.path().filename().string().starts_with("lvp_icd")) continue;
            std::ifstream file(entry.path());
            const std::string text(std::istreambuf_iterator<char>(file), {});
            const size_t at = std::min(text.find("\"api_version\""), text.size());
            unsigned headers = 0;
            if (std::sscanf(text.c_str() + at, "\"api_version\" : \"%*u.%*u.%u", &headers) != 1 ||
                headers > 230)
                return false;
        }
    }
    return true;
}

} // namespace

void useWideVectors() {
    if (processorHasAvx512() && lavapipeIsRightWith16Lanes())
        ::setenv("LP_NATIVE_VECTOR_WIDTH", "512", 0 /* keep the user's */);
}

void useDriverThreads(uint32_t threads) {
    ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

void leaveOutDriversOfAbsentGpus() {
    // Those that reach their GPU through the kernel's direct rendering manager alone.
    constexpr const char* kDrivers = "asahi_icd*,broadcom_icd*,intel_icd*,intel_hasvk_icd*,"
                                     "nouveau_icd*,panfrost_icd*,powervr_mesa_icd*,radeon_icd*";
    for (const char* const name :
         {"VK_LOADER_DRIVERS_DISABLE", "VK_LOADER_DRIVERS_SELECT", "VK_DRIVER_FILES",
          "VK_ADD_DRIVER_FILES", "VK_ICD_FILENAMES", "RADV_FORCE_FAMILY"})
        if (std::getenv(name)) return;
    std::error_code unknown;
    const bool isAbsent = !std::filesystem::exists("/dev/dri", unknown) && !unknown;
    if (isAbsent) ::setenv("VK_LOADER_DRIVERS_DISABLE", kDrivers, 1);
}

void useMemoryInLargePieces() {
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) // the sanitizer has its own
    constexpr size_t kHeap = size_t(512) << 20;          // as much as starts of most scenes ask for
    // In a virtual machine that gives its free memory back a page of 2 MiB takes 0.2 ms, or 7 ms
    // where the memory has to come back first: as long as 512 small ones of 0.4 or 14 us. Small
    // ones come from what has not been given back, but may cost an exception that the machine's
    // host has to serve. Between these two, large ones are worth it (docs/results.md, "Pages of
    // 2 MiB").
    constexpr double kDearPage = 5e-6;
    constexpr int kKept = 1 << 30; // more than that, or it would go back at once
    ::mallopt(M_TRIM_THRESHOLD, kKept);
    ::mallopt(M_MMAP_THRESHOLD, kKept);
    // A thread's own arena asks the system for each 4 KiB more; that of all asks for this much.
    ::mallopt(M_ARENA_MAX, 1);
    ::mallopt(M_TOP_PAD, 1 << 20);
    auto* const heap = static_cast<std::byte*>(std::malloc(kHeap)); // nothing is behind it yet
    if (heap && secondsOfASmallPage() > kDearPage) preferHugePages({heap, kHeap});
    std::free(heap);
#endif
}

} // namespace stromboli::process
