#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// How well a survey knows a marker: standard deviations of each of x, y and z, and of the yaw.
struct MarkerSigma {
  double position_m = 0.0;
  double yaw_rad = 0.0;
  double tilt_rad = 0.0;  ///< about each horizontal axis, of a marker that should lie level
};

/// One surveyed marker: the centre of its dot O, and the direction O->X counter-clockwise from the x axis
/// seen from above, both in the registry's frame.
struct RegisteredMarker {
  int id = 0;
  Vec3 position_m = Vec3::Zero();
  double yaw_rad = 0.0;
  int line = 0;                      ///< line number in its file, for messages; 0 when it has none
  std::optional<MarkerSigma> sigma;  ///< nothing where nobody has said
};

/// All surveyed markers, and the registry's transform to the occupancy map.
struct MarkerRegistry {
  Pose2 map_from_registry;
  std::vector<RegisteredMarker> markers;

  /// Empty when no marker, or more than one, has this ID: a robot must not guess which.
  [[nodiscard]] const RegisteredMarker* find(int id) const;
};

/// All IDs, in the order of the markers.
std::vector<int> registered_ids(const MarkerRegistry& registry);

/// Marker frame to map frame. The marker's z axis points down, so its y axis points to yaw - 90 degrees.
Eigen::Isometry3d map_from_marker(const MarkerRegistry& registry, const RegisteredMarker& marker);

/// Reads a `format: lodestar-markers` file. Throws InputError with file and line for an unknown, missing or
/// ill-typed key, a number that is not finite, an ID outside 0..4095 or listed twice.
MarkerRegistry load_registry(const std::filesystem::path& file);

/// The same for `markers check` and the like, which report mistakes: an ID may be listed twice.
MarkerRegistry load_registry_draft(const std::filesystem::path& file);

/// Writes one marker per line, atomically: a reader sees either the complete old file or the complete new
/// one.
void save_registry(const MarkerRegistry& registry, const std::filesystem::path& file);

}  // namespace lodestar
