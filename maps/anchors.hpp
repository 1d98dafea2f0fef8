#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "maps/geometry.hpp"

// What a person knows of a site that a survey cannot see: where something is on the map, and how long a metre
// is.
namespace lodestar {

/// A heading that somebody measured.
struct AnchorYaw {
  double yaw_rad = 0.0;
  double sigma_rad = 0.0;
};

/// The dot O of this marker is here.
struct MarkerAnchor {
  int id = 0;
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;
  std::optional<AnchorYaw> yaw;
};

/// The robot stood here at this time of a log's clock.
struct RobotAnchor {
  double at_s = 0.0;
  std::string log;  ///< empty when there is only one
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;
  std::optional<AnchorYaw> yaw;
};

/// The dots O of these two markers are so far apart, in a straight line.
struct DistanceAnchor {
  int first = 0;
  int second = 0;
  double distance_m = 0.0;
  double sigma_m = 0.0;
};

/// Printed size over nominal size, of all markers.
struct PrintScale {
  double scale = 1.0;
  double sigma = 0.002;  ///< of an office printer or a plotter whose scale nobody has measured
};

/// One anchor, with the line of its file for messages.
struct Anchor {
  std::variant<MarkerAnchor, RobotAnchor, DistanceAnchor> what;
  int line = 0;
};

struct Anchors {
  std::vector<Anchor> anchors;
  PrintScale print_scale;
};

/// In words: `marker 447`, `robot at 12.5 s`, `distance between 447 and 1782`.
std::string to_string(const Anchor& anchor);

/// Reads a `format: lodestar-anchors` file. Throws InputError with file and line for an unknown, missing or
/// ill-typed key, a number that is not finite, a sigma that is not positive, an ID outside 0..4095.
Anchors load_anchors(const std::filesystem::path& file);

}  // namespace lodestar
