#include "host/core/memory.hpp"

#include <unistd.h>

namespace stromboli {

uint64_t physicalMemory() {
    return uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE));
}

} // namespace stromboli
