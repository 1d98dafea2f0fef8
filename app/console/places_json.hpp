#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "app/site/site.hpp"

// The page's document of all that people name on a map.
namespace lodestar {

/// places.yaml as JSON: the same lists and keys, yaw_deg, max_mps and name only where there is one.
nlohmann::ordered_json places_json(const Places& places);

/// {"name", "places" or "stops", "repeat"}: names alone where nothing is done at the stops, as in the file.
nlohmann::ordered_json mission_json(const NamedMission& mission);

/// Why a document cannot be used, and the item that is to blame where one is.
struct PlacesRefusal {
  std::string words;
  std::string list;  ///< its key; empty when no item is to blame
  std::size_t index = 0;
};

/// {"error", "list", "index"}.
nlohmann::ordered_json refusal_json(const PlacesRefusal& refusal);

/// As strict as places.yaml itself is read, and with speeds that the robot can drive at.
std::variant<Places, PlacesRefusal> places_from_json(const std::string& document, const Robot& robot);

}  // namespace lodestar
