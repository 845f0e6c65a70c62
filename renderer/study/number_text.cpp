#include "study/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lumi {
namespace {

/// Place of the first digit: 0 for 1 to 9.99, -1 for tenths.
int magnitudeOf(double value) { return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string raised(int exponent) {
    static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text;
    for (const char c : std::to_string(exponent)) text += c == '-' ? "⁻" : kDigits[c - '0'];
    return text;
}

}  // namespace

NumberText numberText(const Interval& interval) {
    if (!std::isfinite(interval.mean)) return {"-", "", 0};
    double half = interval.known() && std::isfinite(interval.low) ? (interval.high - interval.low) / 2 : 0;
    if (half < 1e-9 * std::abs(interval.mean)) half = 0;  // what rounding leaves of values that are all the same
    const double size = std::max(std::abs(interval.mean), half);
    NumberText text;
    if (size > 0 && (size >= 1e6 || size < 1e-3)) text.exponent = magnitudeOf(size);
    const double scale = std::pow(10.0, -text.exponent);
    const int magnitude = magnitudeOf(size * scale);
    int decimals = 3 - magnitude;
    if (half > 0) decimals = std::min(1 - magnitudeOf(half * scale), 5 - magnitude);
    decimals = std::max(decimals, 0);
    text.mean = fmt::format("{:.{}f}", interval.mean * scale, decimals);
    if (interval.known() && std::isfinite(interval.low)) text.half = fmt::format("{:.{}f}", half * scale, decimals);
    return text;
}

std::string plainText(const NumberText& number) {
    const std::string body = number.half.empty() ? number.mean : number.mean + " ± " + number.half;
    if (number.exponent == 0) return body;
    return (number.half.empty() ? body : '(' + body + ')') + "·10" + raised(number.exponent);
}

std::string latexText(const NumberText& number, bool strong) {
    if (number.mean == "-") return "--";
    std::string body = strong ? "\\mathbf{" + number.mean + "}" : number.mean;
    if (!number.half.empty()) body += " \\pm " + number.half;
    if (number.exponent != 0)
        body = (number.half.empty() ? body : "(" + body + ")") + fmt::format(" \\cdot 10^{{{}}}", number.exponent);
    return "$" + body + "$";
}

}  // namespace lumi
