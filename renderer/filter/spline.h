#pragma once

namespace lumi {

/// B3 spline of the à-trous filters, by row and by column [Schied17, sec. 4.3; Dammertz10].
constexpr float kSpline[5] = {1.0f / 16, 1.0f / 4, 3.0f / 8, 1.0f / 4, 1.0f / 16};

}  // namespace lumi
