#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "maps/marker_registry.hpp"

// The registry as the page sees it: {"alignment": {x_m, y_m, yaw_deg}, "markers": [{id, x_m, y_m, z_m,
// yaw_deg}]}, in the registry's own frame.
namespace lodestar {

nlohmann::ordered_json registry_json(const MarkerRegistry& registry);

/// Reads what a page sent. Throws InputError, naming the marker by its position in the list, for an unknown,
/// missing or ill-typed key, a number beyond 100 km, or an ID outside 0..4095. A duplicate ID is accepted: a
/// draft may be wrong.
MarkerRegistry registry_from_json(const std::string& text);

/// The first duplicate ID, if any.
std::optional<int> repeated_id(const MarkerRegistry& registry);

}  // namespace lodestar
