#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "app/placement/registry_check.hpp"
#include "maps/height_bands.hpp"
#include "maps/marker_registry.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

// Which markers a robot sees from a position at every heading, and where it sees none.
namespace lodestar {

/// What an upward camera covers at every heading: a disc on the ceiling that grows with its height.
struct AllHeadingsView {
  double camera_height_m = 0.0;
  double reach_per_m = 0.0;  ///< disc radius per metre above the camera, by its view's narrowest side
  double margin_m = 0.0;     ///< subtracted: half a marker and the camera's offset from the robot's centre

  /// Horizontal distance from the centre of a marker at this height within which the robot sees it at every
  /// heading.
  [[nodiscard]] double reach_m(double marker_height_m) const;
};

/// The floor that markers are to cover.
struct CoveredFloor {
  OccupancyMap map;
  /// Occlusions by height. Without them everything occupied on the map is taken to reach the ceiling, except
  /// directly below a marker.
  std::optional<HeightBands> heights;
  double room_m = 0.0;  ///< the robot's centre is never nearer to a cell that is not free
  AllHeadingsView view;
  std::vector<Path> routes;  ///< the usual routes
};

/// Connected areas where the robot can be but sees no marker, of 0.1 square metres or more, the largest
/// first.
std::vector<RegistryIssue> find_gaps(const MarkerRegistry& registry, const CoveredFloor& floor);

/// Stretches of the routes without a marker in view that are longer than the robot should drive by odometry
/// alone (1 m), the longest first. A stretch driven in both directions counts once.
std::vector<RegistryIssue> find_blind_stretches(const MarkerRegistry& registry, const CoveredFloor& floor);

struct BlindStretch {
  Vec2 from_m = Vec2::Zero();
  Vec2 to_m = Vec2::Zero();
  double length_m = 0.0;
};

/// The same stretches of one way, in its order.
std::vector<BlindStretch> blind_stretches_of(const Path& way, const MarkerRegistry& registry,
                                             const CoveredFloor& floor);

/// All errors and warnings about the markers of a site: those of check_registry, implausible numbers, blind
/// stretches and gaps. When cancelled it ends after the step at hand, with what it has.
std::vector<RegistryIssue> check_coverage(const MarkerRegistry& registry, const CoveredFloor& floor,
                                          const std::stop_token& cancelled = {});

}  // namespace lodestar
