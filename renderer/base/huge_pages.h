#pragma once
#include <cstddef>

namespace lumi {

/// Asks the system to move what is in memory to huge pages, where it has some: for large tables that are read here and
/// there, whose every other read would have to look a page up. Contents stay, and so do addresses. It costs a copy of
/// what is not on such pages yet; of what is, next to nothing. Where the system does not do it at once it may later, or
/// never.
void gatherOnHugePages(const void* begin, size_t bytes);

/// The same of all that the program holds, where nearly all of a huge page (2 MiB) is in use: also what libraries hold,
/// such as Embree's trees. For when a scene is built: a page takes about a millisecond, and none is begun after
/// `seconds`. Other threads may go on. Returns the bytes that lie on huge pages then; 0 where the system has none.
size_t gatherAllOnHugePages(double seconds);

}  // namespace lumi
