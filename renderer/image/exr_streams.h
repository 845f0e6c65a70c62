#pragma once
#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lumi {

/// OpenEXR's output into memory.
class ExrByteWriter : public Imf::OStream {
public:
    explicit ExrByteWriter(const std::string& name) : Imf::OStream(name.c_str()) {}
    void write(const char bytes[], int count) override;
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }
    std::vector<uint8_t> take() { return std::move(bytes_); }

private:
    std::vector<uint8_t> bytes_;
    uint64_t position_ = 0;
};

/// OpenEXR's input from memory; reading past the end throws, as OpenEXR wants it.
class ExrByteReader : public Imf::IStream {
public:
    ExrByteReader(std::span<const uint8_t> bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}
    bool read(char target[], int count) override;
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    std::span<const uint8_t> bytes_;
    uint64_t position_ = 0;
};

}  // namespace lumi
