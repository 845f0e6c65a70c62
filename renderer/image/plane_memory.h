#pragma once
#include <cstddef>

namespace lumi {

/// Memory for images: begins on a cache line, and large blocks at ever other distances from the start of their page.
/// Filters read a pixel of a dozen images at a time; if all began at the same distance, as large blocks of the general
/// allocator do, they would fight for the few cache lines that such addresses may occupy. (The planes of one image lie
/// without gaps.) Throws std::bad_alloc. The bytes are not set.
void* allocatePlaneMemory(size_t bytes);
void freePlaneMemory(void* block) noexcept;

/// The same for standard containers.
template <class T>
struct PlaneAllocator {
    using value_type = T;

    PlaneAllocator() = default;
    template <class U>
    PlaneAllocator(const PlaneAllocator<U>&) {}
    T* allocate(size_t count) { return static_cast<T*>(allocatePlaneMemory(count * sizeof(T))); }
    void deallocate(T* block, size_t) noexcept { freePlaneMemory(block); }
    bool operator==(const PlaneAllocator&) const = default;
};

}  // namespace lumi
