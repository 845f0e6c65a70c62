#pragma once
#include <cstddef>
#include <vector>

namespace lumi {

/// Sets the size of a vector whose contents are of no more use. Where it has to grow it takes an eighth more than asked
/// for, and gives back what it had first; resize() would take twice as much, and hold both at a time.
template <class T>
void resizeAnew(std::vector<T>& vector, size_t count) {
    if (count > vector.capacity()) {
        std::vector<T>().swap(vector);
        vector.reserve(count + count / 8);
    }
    vector.resize(count);
}

/// Bytes that a vector holds, used or not.
template <class T>
size_t heldBytes(const std::vector<T>& vector) {
    return vector.capacity() * sizeof(T);
}

}  // namespace lumi
