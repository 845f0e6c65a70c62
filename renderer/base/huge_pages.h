#pragma once
#include <cstddef>

namespace lumi {

/// Asks the system to move what is in memory to huge pages, where it has some: for large tables that are read here and
/// there, whose every other read would have to look a page up. Contents stay, and so do addresses. It costs a copy of
/// what is not on such pages yet; of what is, next to nothing. Where the system does not do it at once it may later, or never.
void gatherOnHugePages(const void* begin, size_t bytes);

}  // namespace lumi
