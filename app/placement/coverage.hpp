#pragma once

#include <optional>
#include <vector>

#include "app/placement/registry_check.hpp"
#include "maps/height_bands.hpp"
#include "maps/marker_registry.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

// Which markers a robot is sure to see from a place, however it has turned; and where it sees none.
namespace lodestar {

/// What a camera that looks up takes in on all sides: a disc on the ceiling, the wider the higher it is.
struct SureView {
  double camera_height_m = 0.0;
  double reach_per_m = 0.0;  ///< of height above the camera: towards the narrowest side of its view
  double margin_m = 0.0;     ///< less half a marker and the camera's distance from the middle of the robot

  /// From a marker's middle this high to the middle of the farthest robot that is sure to see it.
  [[nodiscard]] double reach_m(double marker_height_m) const;
};

/// The floor that markers are to cover.
struct CoveredFloor {
  OccupancyMap map;
  /// What hides markers. Without, all that is occupied on the map is taken to reach the ceiling, but for what
  /// a marker hangs over.
  std::optional<HeightBands> heights;
  double room_m = 0.0;  ///< the middle of the robot is never nearer to what is not free
  SureView view;
  std::vector<Path> routes;  ///< that are usually driven
};

/// Places that the robot can be in and that see no marker, each a tenth of a square metre or more, the
/// largest first.
std::vector<RegistryIssue> find_gaps(const MarkerRegistry& registry, const CoveredFloor& floor);

/// Stretches of the routes, longer than the wheels alone should carry the robot (1 m), that see no marker,
/// the longest first. One that is driven there and back counts once.
std::vector<RegistryIssue> find_blind_stretches(const MarkerRegistry& registry, const CoveredFloor& floor);

/// All that is wrong or doubtful with the markers of a site: what check_registry finds, blind stretches,
/// gaps.
std::vector<RegistryIssue> check_coverage(const MarkerRegistry& registry, const CoveredFloor& floor);

}  // namespace lodestar
