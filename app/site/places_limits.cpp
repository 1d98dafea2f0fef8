#include "app/site/places_limits.hpp"

#include <fmt/format.h>

namespace lodestar {

std::optional<TooSlow> first_too_slow(const Places& places, const Robot& robot) {
  const double slowest_mps = robot.dead_band_mps.value_or(0.0);
  const std::string wanted = fmt::format("at least the robot's dead_band_mps, {}", slowest_mps);
  for (std::size_t i = 0; i < places.speed_zones.size(); ++i) {
    const SpeedZone& zone = places.speed_zones[i];
    if (zone.max_mps < slowest_mps)
      return TooSlow{"speed_zones", i, fmt::format("max_mps {} of speed zone '{}'", zone.max_mps, zone.name),
                     wanted};
  }
  for (std::size_t i = 0; i < places.edges.size(); ++i) {
    const RouteEdge& edge = places.edges[i];
    if (edge.max_mps && *edge.max_mps < slowest_mps)
      return TooSlow{"edges", i,
                     fmt::format("max_mps {} of the edge '{}' to '{}'", *edge.max_mps, edge.from, edge.to),
                     wanted};
  }
  return std::nullopt;
}

}  // namespace lodestar
