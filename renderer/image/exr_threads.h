#pragma once
#include <OpenEXR/ImfThreading.h>

#include <mutex>

#include "base/parallel.h"

namespace lumi {

/// Threads for one OpenEXR file; sets up the library's own pool at the first call. Blocks of lines are compressed each
/// by itself and stored in order, so the count never shows in the bytes.
inline int exrThreads() {
    static std::once_flag once;
    std::call_once(once, [] { Imf::setGlobalThreadCount(threadCount() > 1 ? threadCount() : 0); });
    return threadCount() > 1 ? Imf::globalThreadCount() : 0;
}

}  // namespace lumi
