#pragma once

#include <span>
#include <vector>

#include "app/site/goal.hpp"
#include "maps/geometry.hpp"
#include "maps/map_overlay.hpp"

namespace lodestar {

/// Where paths begin and what they lead to, in the map frame. Rings around people leave room there.
struct PathEnds {
  Vec2 robot_m;
  std::span<const Goal> goals;
  double room_m = 0.0;  ///< that the robot needs around its middle
};

/// Gathers what a path keeps off, seen in the odometry frame, as points of the map frame; what the map
/// explains is left out. The explanation and the goals must outlive this.
class PathObstacles {
 public:
  PathObstacles(const MapExplanation& explanation, const Pose2& map_from_odom, const PathEnds& ends)
      : explanation_(explanation), map_from_odom_(map_from_odom), ends_(ends) {}

  /// With so much room around it, if any.
  void add(const Vec2& hit_in_odom, double radius_m);
  void add_also_if_mapped(const Vec2& hit_in_odom, double radius_m);

  /// How large a ring leaves the robot where it is, and room at the goals; negative where none does.
  [[nodiscard]] double room_before_robot_m(const Vec2& hit_in_odom) const;
  [[nodiscard]] double room_before_goals_m(const Vec2& hit_in_odom) const;

  [[nodiscard]] const std::vector<Vec2>& points_m() const { return points_m_; }

 private:
  [[nodiscard]] bool is_mapped(const Vec2& point_in_map) const;

  const MapExplanation& explanation_;
  Pose2 map_from_odom_;
  PathEnds ends_;
  std::vector<Vec2> points_m_;
};

}  // namespace lodestar
