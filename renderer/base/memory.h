#pragma once
#include <cstdint>
#include <string>

namespace lumi {

/// Bytes that large allocations may take together; the default is 75% of the machine's memory.
void setMemoryLimit(uint64_t bytes);
uint64_t memoryLimit();

/// Throws Error(Resources) naming `what` and its size if the process, grown by `bytes`, would pass the limit.
/// Call before every allocation whose size comes from a file or from a user.
void checkMemory(const std::string& what, uint64_t bytes);

/// Resident bytes of the process now, and at its peak.
uint64_t residentBytes();
uint64_t peakResidentBytes();

/// "1.5 GiB", "640 KiB"; parseBytes reads "512M", "2GiB", "75%" (of the machine's memory); throws Error(Usage) headed
/// by `where`.
std::string formatBytes(uint64_t bytes);
uint64_t parseBytes(const std::string& text, const std::string& where = "");

}  // namespace lumi
