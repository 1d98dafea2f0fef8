#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/site/goal.hpp"

namespace lodestar {

/// A named goal.
struct Place {
  std::string name;
  Goal goal;
};

/// Places in driving order.
struct NamedRoute {
  std::string name;
  std::vector<std::string> places;
};

/// routes.yaml of a site folder:
///
///     format: lodestar-routes
///     version: 1
///     places:
///       - {name: "desk", x_m: 1.2, y_m: 3.4, yaw_deg: 90}
///     routes:
///       - {name: "round", places: ["desk", "door"]}
struct Routes {
  std::vector<Place> places;
  std::vector<NamedRoute> routes;
};

/// Strict: throws InputError with file and line, also for a duplicate name, an empty route or an unknown
/// place. JSON of the same shape is read as well. `file` is used in error messages only.
Routes parse_routes(const std::string& text, const std::filesystem::path& file);

/// Routes of a file; none when the file does not exist.
Routes load_routes(const std::filesystem::path& file);

/// YAML with one place or route a line.
std::string routes_text(const Routes& routes);

nlohmann::ordered_json routes_json(const Routes& routes);

}  // namespace lodestar
