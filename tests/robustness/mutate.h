#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace lumi {

/// Damages a good file in one of the ways that real files are damaged: cut short, bits flipped, bytes overwritten with
/// values that parsers trip over, parts doubled or dropped, and, for text, numbers and keys exchanged for hostile ones.
/// The same generator state gives the same damage.
class Mutator {
public:
    explicit Mutator(uint64_t seed) : random_(seed) {}

    std::string mutate(std::string bytes, bool isText) {
        const int rounds = 1 + pick(3);
        for (int i = 0; i < rounds && !bytes.empty(); ++i) isText&& pick(3) ? damageText(bytes) : damageBytes(bytes);
        return bytes;
    }

private:
    int pick(int count) { return static_cast<int>(random_() % static_cast<uint64_t>(count)); }
    size_t place(const std::string& bytes) { return bytes.empty() ? 0 : static_cast<size_t>(random_() % bytes.size()); }

    void damageBytes(std::string& bytes) {
        const size_t at = place(bytes);
        switch (pick(7)) {
            case 0: bytes.resize(at); break;
            case 1: bytes[at] = static_cast<char>(bytes[at] ^ (1 << pick(8))); break;
            case 2: bytes[at] = static_cast<char>(pick(256)); break;
            case 3: overwriteWord(bytes, at); break;
            case 4: bytes.erase(at, static_cast<size_t>(1 + pick(64))); break;
            case 5: bytes.insert(at, bytes.substr(place(bytes), static_cast<size_t>(1 + pick(64)))); break;
            default:
                bytes.insert(at, std::string(static_cast<size_t>(1 + pick(16)), static_cast<char>(pick(256))));
                break;
        }
    }
    void overwriteWord(std::string& bytes, size_t at) {
        static constexpr uint32_t kWords[] = {
            0, 1, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x7fc00000u, 0x7f800000u, 0xffffff00u, 65536, 0x01000000u,
            // As floats: 1e18, -3e19, 1e25, 3e38, 1e9, 1e-30.
            0x5d5e0b6bu, 0xdfd02ab4u, 0x69045951u, 0x7f61b1e6u, 0x4e6e6b28u, 0x0da24260u};
        const uint32_t word = kWords[pick(16)];
        for (size_t i = 0; i < 4 && at + i < bytes.size(); ++i) bytes[at + i] = static_cast<char>(word >> (8 * i));
    }
    /// Exchanges one number or string of a text for a hostile one.
    void damageText(std::string& bytes) {
        static const std::vector<std::string> kNumbers = {
            "-1",         "0",          "1e999",  "-1e308", "99999999999999999999",
            "4294967295", "2147483648", "1e-320", "nan",    "0.5",
            "true",       "null",       "[]",     "{}",     "\"\"",
            "1e9",        "-2e9",       "1e18",   "3e19",   "-1e25",
            "1e30",       "3e38",       "1e-30"};
        static const std::vector<std::string> kStrings = {"../../../../etc/passwd",
                                                          "/dev/zero",
                                                          "",
                                                          "\\ud800",
                                                          "\xff\xfe",
                                                          "%00",
                                                          "data:,",
                                                          "a/../..",
                                                          "data:application/octet-stream;base64,AAAA",
                                                          "SCALAR",
                                                          "VEC4",
                                                          "KHR_draco_mesh_compression"};
        size_t at = place(bytes);
        if (pick(4) == 0) {
            const size_t open = bytes.find('"', at),
                         close = open == std::string::npos ? open : bytes.find('"', open + 1);
            if (close == std::string::npos) return damageBytes(bytes);
            bytes.replace(open + 1, close - open - 1,
                          kStrings[static_cast<size_t>(pick(static_cast<int>(kStrings.size())))]);
            return;
        }
        at = bytes.find_first_of("0123456789", at);
        if (at == std::string::npos) return damageBytes(bytes);
        const size_t end = bytes.find_first_not_of("0123456789.eE+-", at);
        bytes.replace(at, (end == std::string::npos ? bytes.size() : end) - at,
                      kNumbers[static_cast<size_t>(pick(static_cast<int>(kNumbers.size())))]);
    }

    std::mt19937_64 random_;
};

}  // namespace lumi
