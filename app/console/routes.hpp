#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "maps/places.hpp"

// The page's document of places and of the routes over them, which are the missions of places.yaml.
namespace lodestar {

/// {"format": "lodestar-routes", "version", "places": [{"name", "x_m", "y_m", "yaw_deg"}],
/// "routes": [{"name", "places": [...]}]}; yaw_deg only where a place has one.
nlohmann::ordered_json routes_json(const Places& places);

/// The places with those and the missions of a document of the page; all else stays. Throws InputError for an
/// unusable document, and for one that takes away what an edge needs.
Places with_routes(Places places, const std::string& document);

}  // namespace lodestar
