#include "runtime/robust_loss.h"

#include <cmath>

namespace foresight {

double rho(Loss loss, double u) {
  const double square = u * u;
  switch (loss) {
    case Loss::lorentzian:
      return std::log1p(0.5 * square);  // Equation (8)
    case Loss::tukey: {
      constexpr double c = kTukeyConstant;
      const double rest = 1.0 - square / (c * c);
      return c * c / 6.0 * (rest > 0.0 ? 1.0 - rest * rest * rest : 1.0);
    }
    case Loss::huber:
      if (std::abs(u) > kHuberConstant) return kHuberConstant * (std::abs(u) - 0.5 * kHuberConstant);
      break;
    case Loss::gaussian:
      break;
  }
  return 0.5 * square;
}

double weight(Loss loss, double u) {
  switch (loss) {
    case Loss::lorentzian:
      return 1.0 / (1.0 + 0.5 * u * u);
    case Loss::tukey: {
      const double rest = 1.0 - u * u / (kTukeyConstant * kTukeyConstant);
      return rest > 0.0 ? rest * rest : 0.0;
    }
    case Loss::huber:
      if (std::abs(u) > kHuberConstant) return kHuberConstant / std::abs(u);
      break;
    case Loss::gaussian:
      break;
  }
  return 1.0;
}

double psi(Loss loss, double u) { return weight(loss, u) * u; }

}  // namespace foresight
