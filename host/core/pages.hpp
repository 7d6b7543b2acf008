#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace stromboli {

/// Bytes of the system's smallest pages on the machines that the program is made for. A larger page
/// costs nothing but that devices do not read arrays where they lie (vulkan::Buffer).
constexpr std::size_t kPageBytes = 4096;

constexpr std::size_t wholePages(std::size_t bytes) {
    return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
}

/// Asks the system for pages of 2 MiB behind memory that nothing has been written to yet. A tree of
/// millions of triangles is read in no order: with pages of 4 KiB nearly every record of it is a
/// miss in the processor's table of pages as well. Only a request: nothing changes where the system
/// has no such pages.
void preferHugePages(std::span<std::byte> memory);

/// Takes pages of 2 MiB for memory that all of will be written to, as long as the system has some
/// at hand: after one that took longer than 512 small ones (secondsOfASmallPage()) the rest gets
/// small ones. In a virtual machine that has given its free memory back a page of 2 MiB may take
/// thirty times as long as one that is there, and small ones come from what has not been given
/// back. Bytes in pages that are taken have any value.
void takeHugePages(std::span<std::byte> memory);

/// CPU seconds that the system takes to give a page of 4 KiB: the mean of 64, measured once.
double secondsOfASmallPage();

/// Memory in whole pages that belong to one array alone, so that a device of which the memory is
/// the host's can read the array where it lies (vulkan::Buffer).
template <class T>
struct PageAllocator {
    using value_type = T;

    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>&) {}

    T* allocate(std::size_t n) {
        const std::size_t bytes = wholePages(n * sizeof(T));
        void* const memory = ::operator new(bytes, std::align_val_t(kPageBytes));
        takeHugePages({static_cast<std::byte*>(memory), bytes});
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t) {
        ::operator delete(memory, std::align_val_t(kPageBytes));
    }
    /// Elements of an array that is made larger have no value, as new ones on the stack: to clear
    /// an array of a hundred MB takes as long as to fill it, and on one thread.
    template <class U>
    void construct(U* element) {
        ::new (static_cast<void*>(element)) U;
    }
    template <class U, class... Values>
    void construct(U* element, Values&&... values) {
        ::new (static_cast<void*>(element)) U(std::forward<Values>(values)...);
    }
    template <class U>
    bool operator==(const PageAllocator<U>&) const {
        return true;
    }
};

template <class T>
using PageVector = std::vector<T, PageAllocator<T>>;

} // namespace stromboli
