#include "app/ros2/ros2_commands.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace lodestar {

std::variant<Pose2, std::string> planar_pose(const ReceivedPose& received) {
  constexpr double farthest_m = 1e4;
  constexpr double unit_within = 0.01;
  const auto& [x, y, z, w] = received.quaternion;
  // Some programs write the leading slash of ROS 1.
  if (received.frame != "map" && received.frame != "/map")
    return fmt::format("found frame '{}', wanted map", received.frame.substr(0, 40));
  if (!received.position_m.allFinite() || !std::isfinite(x + y + z + w))
    return std::string("found a number that is not finite");
  if (received.position_m.head<2>().cwiseAbs().maxCoeff() > farthest_m)
    return std::string("found a place beyond 10 km");
  const Eigen::Quaterniond turn(w, x, y, z);
  if (std::abs(turn.norm() - 1.0) > unit_within)
    return fmt::format("found a quaternion of length {:.3g}, wanted 1", turn.norm());
  const Eigen::Matrix3d rotation = turn.normalized().toRotationMatrix();
  if (rotation(2, 2) < std::cos(radians(5.0))) return std::string("found a pose that does not stand upright");
  return Pose2{received.position_m.head<2>(), std::atan2(rotation(1, 0), rotation(0, 0))};
}

PlacingSigma placing_sigma(const std::array<double, 36>& covariance) {
  constexpr std::size_t yy = 7;
  constexpr std::size_t yaw = 35;
  PlacingSigma sigma;
  const double position = std::max(covariance[0], covariance[yy]);
  if (std::isfinite(position) && position > 0.0)
    sigma.position_m = std::clamp(std::sqrt(position), 0.01, 1.0);
  if (std::isfinite(covariance[yaw]) && covariance[yaw] > 0.0)
    sigma.heading_rad = std::clamp(std::sqrt(covariance[yaw]), radians(0.5), radians(30.0));
  return sigma;
}

}  // namespace lodestar
