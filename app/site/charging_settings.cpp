#include "app/site/charging_settings.hpp"

#include <fmt/format.h>

namespace lodestar {

ChargingSettings read_charging_settings(StrictYaml yaml, const Places& places) {
  constexpr double most_v = 1000.0;
  ChargingSettings charging;
  charging.place = yaml.text("place");
  const Place* const dock = places.find(charging.place);
  if (dock == nullptr || !dock->yaw_rad)
    yaml.refuse("place", "'" + charging.place + "'", "a place of places.yaml that has a heading");
  charging.map_from_dock = {dock->position_m, *dock->yaw_rad};
  if (yaml.has("approach_m")) charging.approach_m = yaml.number("approach_m", 0.1, 5.0);
  if (yaml.has("approach_mps")) charging.approach_mps = yaml.number("approach_mps", 0.01, 1.0);
  if (yaml.has("rise_v")) charging.rise_v = yaml.number("rise_v", 0.1, 20.0);
  charging.full_v = yaml.number("full_v", 1.0, most_v);
  if (yaml.has("low_v")) charging.low_v = yaml.number("low_v", 1.0, most_v);
  if (charging.low_v && *charging.low_v >= charging.full_v)
    yaml.refuse("low_v", fmt::format("{} V", *charging.low_v),
                fmt::format("less than full_v, {} V", charging.full_v));
  yaml.finish();
  return charging;
}

std::optional<ChargingSettings> charging_at(const std::optional<ChargingSettings>& charging,
                                            const Places& places) {
  const Place* const dock = charging ? places.find(charging->place) : nullptr;
  if (dock == nullptr || !dock->yaw_rad) return std::nullopt;
  ChargingSettings moved = *charging;
  moved.map_from_dock = {dock->position_m, *dock->yaw_rad};
  return moved;
}

Pose2 approach_pose(const ChargingSettings& charging) {
  return charging.map_from_dock * Pose2{{-charging.approach_m, 0.0}, 0.0};
}

}  // namespace lodestar
