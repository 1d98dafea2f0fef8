#include "maps/motion.hpp"

#include <algorithm>
#include <limits>

#include "maps/segment.hpp"

namespace lodestar {

double length_m(const Path& path) {
  double total = 0.0;
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i) {
    total += (path.waypoints_m[i] - path.waypoints_m[i - 1]).norm();
  }
  return total;
}

double distance_to_path_m(const Path& path, const Vec2& point_m) {
  if (path.waypoints_m.size() == 1) return (path.waypoints_m.front() - point_m).norm();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i) {
    nearest = std::min(nearest, distance_to_segment(path.waypoints_m[i - 1], path.waypoints_m[i], point_m));
  }
  return nearest;
}

}  // namespace lodestar
