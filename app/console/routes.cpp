#include "app/console/routes.hpp"

#include <fmt/format.h>
#include <set>

#include "app/common/rounding.hpp"
#include "app/console/document_history.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t longest_name = 80;

/// A quoted string that YAML and JSON read alike.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string new_name(StrictYaml& yaml, std::set<std::string>& taken) {
  std::string name = yaml.text("name");
  if (name.empty() || name.size() > longest_name) yaml.refuse("name", "'" + name + "'", "1 to 80 characters");
  if (!taken.insert(name).second) yaml.refuse("name", "'" + name + "' twice", "each name once");
  return name;
}

Goal goal_of(StrictYaml& yaml) {
  Goal goal{Vec2(yaml.number("x_m", -far_m, far_m), yaml.number("y_m", -far_m, far_m)), std::nullopt};
  if (yaml.has("yaw_deg")) goal.heading_rad = wrap_angle(radians(yaml.number("yaw_deg", -360.0, 360.0)));
  return goal;
}

std::vector<std::string> places_of(StrictYaml& yaml, const std::set<std::string>& known) {
  const YAML::Node list = yaml.node("places");
  std::vector<std::string> places;
  if (!list.IsSequence() || list.size() == 0) yaml.refuse("places", "none", "names of places");
  for (const YAML::Node& entry : list) {
    const std::string name = entry.IsScalar() ? entry.Scalar() : "";
    if (!known.contains(name)) yaml.refuse("places", "'" + name + "'", "names of places");
    places.push_back(name);
  }
  return places;
}

double tidy(double value) {
  return rounded(value, 1e9);
}

std::string place_line(const Place& place) {
  const Vec2& at = place.goal.position_m;
  std::string line =
      fmt::format("  - {{name: {}, x_m: {}, y_m: {}", quoted(place.name), tidy(at.x()), tidy(at.y()));
  if (place.goal.heading_rad) line += fmt::format(", yaw_deg: {}", tidy(degrees(*place.goal.heading_rad)));
  return line + "}\n";
}

std::string route_line(const NamedRoute& route) {
  std::string names;
  for (const std::string& place : route.places) names += (names.empty() ? "" : ", ") + quoted(place);
  return fmt::format("  - {{name: {}, places: [{}]}}\n", quoted(route.name), names);
}

}  // namespace

Routes parse_routes(const std::string& text, const std::filesystem::path& file) {
  StrictYaml yaml = StrictYaml::parse(text, file);
  const std::string format = yaml.text("format");
  if (format != "lodestar-routes") yaml.refuse("format", "'" + format + "'", "'lodestar-routes'");
  (void)yaml.integer("version", 1, 1);
  Routes routes;
  std::set<std::string> known;
  for (StrictYaml& place : yaml.list_of_mappings("places")) {
    std::string name = new_name(place, known);
    routes.places.push_back({std::move(name), goal_of(place)});
    place.finish();
  }
  std::set<std::string> taken;
  for (StrictYaml& route : yaml.list_of_mappings("routes")) {
    std::string name = new_name(route, taken);
    routes.routes.push_back({std::move(name), places_of(route, known)});
    route.finish();
  }
  yaml.finish();
  return routes;
}

Routes load_routes(const std::filesystem::path& file) {
  return std::filesystem::exists(file) ? parse_routes(read_document(file), file) : Routes{};
}

std::string routes_text(const Routes& routes) {
  std::string text = "format: lodestar-routes\nversion: 1\n";
  text += routes.places.empty() ? "places: []\n" : "places:\n";
  for (const Place& place : routes.places) text += place_line(place);
  text += routes.routes.empty() ? "routes: []\n" : "routes:\n";
  for (const NamedRoute& route : routes.routes) text += route_line(route);
  return text;
}

ordered_json routes_json(const Routes& routes) {
  ordered_json places = ordered_json::array();
  for (const Place& place : routes.places) {
    const Vec2& at = place.goal.position_m;
    places.push_back({{"name", place.name}, {"x_m", at.x()}, {"y_m", at.y()}});
    if (place.goal.heading_rad) places.back()["yaw_deg"] = tidy(degrees(*place.goal.heading_rad));
  }
  ordered_json list = ordered_json::array();
  for (const NamedRoute& route : routes.routes)
    list.push_back({{"name", route.name}, {"places", route.places}});
  return {{"format", "lodestar-routes"}, {"version", 1}, {"places", places}, {"routes", list}};
}

}  // namespace lodestar
