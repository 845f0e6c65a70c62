#pragma once
#include <string>

#include "study/intervals.h"

namespace lumi {

/// A mean and the half-width of its interval, as text for tables and figures: decimals where they mean something.
struct NumberText {
    std::string mean, half;  ///< half is empty where nothing is known of the interval
    int exponent = 0;        ///< both times ten to it
};

/// Two digits of the half-width, and as many decimals of the mean, but at most six digits of that; without an interval,
/// or with one of no width, four digits. Very small and very large numbers have an exponent. A mean that is not finite
/// is "-".
NumberText numberText(const Interval& interval);

/// "0.1234 ± 0.0012", "(1.23 ± 0.05)·10⁻⁵", "-".
std::string plainText(const NumberText& number);
/// The same for LaTeX, in math mode; the mean in bold if `strong`.
std::string latexText(const NumberText& number, bool strong);

}  // namespace lumi
