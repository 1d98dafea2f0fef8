#include "control/spare_room.hpp"

#include <algorithm>
#include <cmath>

#include "control/speed_limit.hpp"

namespace lodestar {

SpareRoom room_for_doubt(const Eigen::Matrix3d& covariance) {
  constexpr double usual_sigma_m = 0.005;
  constexpr double sigmas = 3.0;
  const double sigma_m = larger_sigma_m(covariance);
  if (sigma_m < usual_sigma_m) return {};
  return {.here_m = sigmas * (sigma_m - usual_sigma_m),
          .per_m = sigmas * std::sqrt(std::max(covariance(2, 2), 0.0))};
}

}  // namespace lodestar
