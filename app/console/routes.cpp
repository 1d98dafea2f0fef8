#include "app/console/routes.hpp"

#include <utility>

#include "app/console/places_json.hpp"
#include "maps/tidy.hpp"

namespace lodestar {

using nlohmann::ordered_json;

ordered_json routes_json(const Places& places) {
  ordered_json stations = ordered_json::array();
  for (const Place& place : places.places) {
    stations.push_back({{"name", place.name}, {"x_m", place.position_m.x()}, {"y_m", place.position_m.y()}});
    if (place.yaw_rad) stations.back()["yaw_deg"] = tidy(degrees(*place.yaw_rad));
  }
  ordered_json routes = ordered_json::array();
  for (const NamedMission& mission : places.missions) routes.push_back(mission_json(mission));
  return {{"format", "lodestar-routes"}, {"version", 1}, {"places", stations}, {"routes", routes}};
}

Places with_routes(Places places, const std::string& document) {
  Places sent = parse_routes(document, "the routes sent");
  places.places = std::move(sent.places);
  places.missions = std::move(sent.missions);
  // Reading what would be written checks the whole: names of nodes, ends of edges.
  return parse_places(places_text(places), "the places with the routes sent");
}

}  // namespace lodestar
