#include "control/safety_margin.hpp"

#include <algorithm>
#include <cmath>

#include "control/forward_clearance.hpp"
#include "control/speed_limit.hpp"

namespace lodestar {

namespace {

/// Usual position sigma of a robot; paths have the clearance for it.
constexpr double usual_sigma_m = 0.005;

double unusual_m(double sigma_m) {
  return std::sqrt(std::max(sigma_m * sigma_m - usual_sigma_m * usual_sigma_m, 0.0));
}

/// 99 % of normal errors in one direction are below 2.33 standard deviations.
constexpr double sigmas = 2.3;
/// 98 % are below 2: enough where the robot has just passed without a collision.
constexpr double sigmas_on_the_way_back = 2.0;

/// So many standard deviations beyond the usual one, plus ForwardClearance's tolerance.
double margin_m(const Eigen::Matrix3d& covariance, double deviations) {
  const double sigma_m = larger_sigma(covariance.topLeftCorner<2, 2>());
  if (sigma_m < usual_sigma_m) return 0.0;
  const double taken_back = std::min(sigma_m / usual_sigma_m - 1.0, 1.0);
  return deviations * unusual_m(sigma_m) + taken_back * ForwardClearance::usual_tolerance_m;
}

}  // namespace

SafetyMargin margin_for_uncertainty(const Eigen::Matrix3d& covariance) {
  const double here_m = margin_m(covariance, sigmas);
  if (here_m == 0.0) return {};
  return {.here_m = here_m, .per_m = sigmas * std::sqrt(std::max(covariance(2, 2), 0.0))};
}

SafetyMargin margin_on_the_way_back(const Eigen::Matrix3d& covariance) {
  return {.here_m = margin_m(covariance, sigmas_on_the_way_back), .per_m = 0.0};
}

}  // namespace lodestar
