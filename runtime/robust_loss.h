// rho, psi and w of the error distributions compared in Section V.B and Fig. 7, as functions of u = z / sigma.
//
// Contract: rho(0) = 0, rho even and non-decreasing in |u|; psi = d rho / d u; weight = psi(u) / u, with weight(0) its
// limit, 1. Every rho is u^2 / 2 near 0, so that the losses differ only in how they treat large errors.
#pragma once

#include "runtime/foresight.h"

namespace foresight {

// Constants of Haralick et al. 1989 as recommended: 95 % efficiency on Gaussian errors. Unit: sigma.
inline constexpr double kHuberConstant = 1.345;
inline constexpr double kTukeyConstant = 4.685;

// lorentzian: log(1 + u^2 / 2), eq. (8).
// gaussian:   u^2 / 2. The paper writes z^2; half of it is -log P of a normal distribution whose standard deviation is
//             sigma, and the factor moves neither a minimum nor the direction of a gradient.
// huber:      u^2 / 2 up to the constant, straight beyond.
// tukey:      c^2 / 6 (1 - (1 - u^2 / c^2)^3) up to the constant c, level beyond.
[[nodiscard]] double rho(Loss loss, double u);
[[nodiscard]] double psi(Loss loss, double u);
[[nodiscard]] double weight(Loss loss, double u);

}  // namespace foresight
