#include "app/report/ticks.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

double tick_spacing(double extent, double count) {
  const double rough = std::max(extent, 1e-9) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= rough) return step * power;
  }
  return 10.0 * power;
}

}  // namespace lodestar
