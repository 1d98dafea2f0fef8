#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// A marker in the map frame, in metres.
struct MarkerInMap {
  Vec3 middle = Vec3::Zero();
  std::vector<Vec3> dots;
};

/// Markers by place.
class MarkerIndex {
 public:
  /// `reach_m`: horizontally, of those that are asked for; nothing for all of them.
  MarkerIndex(const MarkerRegistry& registry, std::optional<double> reach_m);

  /// In the registry's order: all with their middle within reach, and some farther off.
  [[nodiscard]] std::vector<const MarkerInMap*> about(const Vec2& position_m) const;

 private:
  using Square = std::pair<int, int>;
  [[nodiscard]] Square square_of(const Vec2& position_m) const;

  std::vector<MarkerInMap> markers_;
  std::optional<double> side_m_;  ///< of a square: the reach
  std::map<Square, std::vector<std::size_t>> in_square_;
};

/// The distance over the floor from the robot within which a marker's middle must lie so that a camera sees
/// all of it, at whatever heading; nothing where the camera looks so far to the side that there is no such
/// distance. `highest_m`: of the markers, in the map frame, whose z is that of the base.
std::optional<double> sight_reach_m(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
                                    double highest_m);

}  // namespace lodestar
