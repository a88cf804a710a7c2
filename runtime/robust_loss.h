// rho, psi and w of the error distributions compared in Section V.B and Fig. 7, as functions of u = z / sigma.
//
// Contract: rho(0) = 0, rho even and non-decreasing in |u|; psi = d rho / d u; weight = psi(u) / u, with weight(0) its limit.
#pragma once

#include "runtime/foresight.h"

namespace foresight {

// Constants of Haralick et al. 1989 as recommended: 95 % efficiency on Gaussian errors. Unit: sigma.
inline constexpr double kHuberConstant = 1.345;
inline constexpr double kTukeyConstant = 4.685;

[[nodiscard]] double rho(Loss loss, double u);     // Lorentzian: eq. (8)
[[nodiscard]] double psi(Loss loss, double u);
[[nodiscard]] double weight(Loss loss, double u);

}  // namespace foresight
