#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/ros2/ros2_report.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/scan.hpp"

// The robot's data in the shapes that ROS 2's messages want, without its middleware.
namespace lodestar {

/// The map on a grid along the axes of the map frame, with cells of the same size: navigation stacks pass
/// over the yaw of a grid's origin. A cell takes the value at its centre; what lies beyond is unknown. The
/// map itself where it is not turned.
OccupancyMap axis_aligned(const OccupancyMap& map);

/// A scan with the same angle between all beams (sensor_msgs/LaserScan).
struct EvenScan {
  Stamp stamp;             ///< of the beam measured first
  double first_rad = 0.0;  ///< in the scanner frame, counter-clockwise
  double step_rad = 0.0;
  double step_s = 0.0;  ///< from beam to beam; 0 where they were not measured in this order
  double turn_s = 0.0;  ///< from the first beam measured to the last
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  /// By REP 117: +infinity where nothing came back, -infinity for too near, not a number for invalid.
  std::vector<float> ranges_m;
  std::vector<float> intensities;
};

/// Beams go to the nearest of the even angles, the nearer of two hits wins; where none goes, nothing is
/// known.
EvenScan even(const Scan& scan);

/// One line of a robot's diagnostics (REP 107).
struct DiagnosticLine {
  enum class Level : std::uint8_t { ok = 0, warn = 1, error = 2 };
  Level level = Level::ok;
  std::string name;
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;
};

/// Localization, base and motion.
std::vector<DiagnosticLine> diagnostics_of(const Ros2Report& report);

}  // namespace lodestar
