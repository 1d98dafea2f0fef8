#pragma once

#include <cmath>

namespace lodestar {

/// Huber loss (Huber 1964): quadratic up to `scale` sigmas, linear beyond. The weight is that of the
/// quadratic form.
struct Huber {
  double cost = 0.0;
  double weight = 1.0;
};

inline Huber huber(double squared_sigmas, double scale) {
  if (squared_sigmas <= scale * scale) return {squared_sigmas, 1.0};
  const double sigmas = std::sqrt(squared_sigmas);
  return {scale * (2.0 * sigmas - scale), scale / sigmas};
}

}  // namespace lodestar
