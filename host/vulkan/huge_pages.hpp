#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stromboli::vulkan {

/// Asks the system for pages of 2 MiB behind memory that nothing has been written to yet. A tree of
/// millions of triangles is read in no order: with pages of 4 KiB nearly every record of it is a
/// miss in the processor's table of pages as well. Only a request: nothing changes where the system
/// has no such pages.
void preferHugePages(std::span<std::byte> memory);

} // namespace stromboli::vulkan
