#pragma once

#include <cstdint>

namespace stromboli {

/// The memory of this machine in bytes: what no single thing can need more of.
uint64_t physicalMemory();

} // namespace stromboli
