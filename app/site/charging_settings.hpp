#pragma once

#include <optional>
#include <string>

#include "maps/geometry.hpp"
#include "maps/places.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {

/// Where and how the robot charges: `charging` of site.yaml. docs/charging.md says how to set it up.
struct ChargingSettings {
  std::string place;        ///< of places.yaml, with a heading
  Pose2 map_from_dock;      ///< that place: where the base stands when its contacts touch
  double approach_m = 0.5;  ///< straight ahead, from behind the dock's pose onto it
  double approach_mps = 0.1;
  /// Contacts make the battery's voltage rise at least so much over that at rest before. A pack of 24 V with
  /// 50 to 100 milliohms takes 5 A and more: 0.25 V at once, and more within seconds.
  double rise_v = 0.3;
  double full_v = 0.0;  ///< while charging: the charger's end voltage, less 0.1 or 0.2
  /// At rest; a robot that stands idle below it goes to charge by itself. Nothing: only when told to.
  std::optional<double> low_v;
};

ChargingSettings read_charging_settings(StrictYaml yaml, const Places& places);

/// With its place as these places have it, which may be newer; nothing where they do not have it, or without
/// a heading.
std::optional<ChargingSettings> charging_at(const std::optional<ChargingSettings>& charging,
                                            const Places& places);

/// Where it stops before the last straight way onto the dock.
Pose2 approach_pose(const ChargingSettings& charging);

}  // namespace lodestar
