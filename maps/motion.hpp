#pragma once

#include <Eigen/Core>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

// Motion types shared by localization, planning, control and drivers.
namespace lodestar {

/// Velocity of the base frame: forward along its x axis, turning counter-clockwise.
struct BodyVelocity {
  double forward_mps = 0.0;
  double turn_radps = 0.0;
};

/// Of a command, not of a measured velocity, which is never exactly zero.
inline bool asks_for_motion(const BodyVelocity& command) {
  return command.forward_mps != 0.0 || command.turn_radps != 0.0;
}

/// How far each wheel has rolled since start-up (cumulative, unwrapped), as of `stamp`.
struct WheelTravel {
  Stamp stamp;
  double left_m = 0.0;
  double right_m = 0.0;
};

/// The estimated pose of the robot. The covariance is of (x_m, y_m, yaw_rad) in the map frame.
struct PoseEstimate {
  Stamp stamp;
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Stamp last_fix;     ///< capture time of the newest camera fix that the estimate contains
  Stamp last_agreed;  ///< capture time of the newest frame that confirms it: a fix or visual odometry
};

/// Straight legs in the map frame; the first waypoint is the start, the last the goal.
struct Path {
  std::vector<Vec2> waypoints_m;
};

double length_m(const Path& path);

/// Distance from a point to the nearest point of the path's legs; infinity for an empty path.
double distance_to_path_m(const Path& path, const Vec2& point_m);

}  // namespace lodestar
