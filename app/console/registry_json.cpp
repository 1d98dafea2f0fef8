#include "app/console/registry_json.hpp"

#include <cmath>
#include <fmt/format.h>
#include <set>

#include "app/common/json_parse.hpp"
#include "app/common/rounding.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// A JSON object of numbers; finish() refuses keys that were never read.
class Numbers {
 public:
  Numbers(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) refuse("something else", "an object");
  }

  double at(const char* key) {
    constexpr double most = 1e5;
    asked_.insert(key);
    if (!object_.contains(key) || !object_[key].is_number())
      refuse("none", fmt::format("a number '{}'", key));
    const double value = object_[key].get<double>();
    if (!(std::abs(value) <= most)) refuse(fmt::format("{} {}", key, value), "one within 100000");
    return value;
  }

  int id() {
    const double value = at("id");
    if (value < 0 || value >= marker_id_count || value != std::floor(value)) {
      refuse(fmt::format("ID {}", value), fmt::format("a whole number in 0..{}", marker_id_count - 1));
    }
    return static_cast<int>(value);
  }

  void finish() const {
    for (const auto& item : object_.items()) {
      if (!asked_.contains(item.key())) refuse("an unknown key", "known ones only");
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const {
    throw InputError(fmt::format("{}: found {}, wanted {}", where_, found, wanted));
  }

  const json& object_;
  std::string where_;
  std::set<std::string> asked_;
};

double tidy_degrees(double angle_rad) {
  return rounded(degrees(angle_rad), 1e9);
}

}  // namespace

ordered_json registry_json(const MarkerRegistry& registry) {
  const Pose2& alignment = registry.map_from_registry;
  ordered_json markers = ordered_json::array();
  for (const RegisteredMarker& marker : registry.markers) {
    markers.push_back({{"id", marker.id},
                       {"x_m", marker.position_m.x()},
                       {"y_m", marker.position_m.y()},
                       {"z_m", marker.position_m.z()},
                       {"yaw_deg", tidy_degrees(marker.yaw_rad)}});
  }
  return {{"alignment",
           {{"x_m", alignment.position_m.x()},
            {"y_m", alignment.position_m.y()},
            {"yaw_deg", tidy_degrees(alignment.yaw_rad)}}},
          {"markers", markers}};
}

MarkerRegistry registry_from_json(const std::string& text) {
  const json root = parse_json(text);
  if (!root.is_object() || root.size() != 2 || !root.contains("alignment") || !root.contains("markers") ||
      !root["markers"].is_array()) {
    throw InputError("found something else, wanted {\"alignment\": {...}, \"markers\": [...]}");
  }
  if (root["markers"].size() > marker_id_count) {
    throw InputError(
        fmt::format("found {} markers, wanted no more than there are IDs", root["markers"].size()));
  }
  MarkerRegistry registry;
  Numbers alignment(root["alignment"], "alignment");
  registry.map_from_registry = {{alignment.at("x_m"), alignment.at("y_m")},
                                wrap_angle(radians(alignment.at("yaw_deg")))};
  alignment.finish();
  for (const json& entry : root["markers"]) {
    Numbers numbers(entry, fmt::format("marker {} of the list", registry.markers.size() + 1));
    const int id = numbers.id();
    const Vec3 position_m(numbers.at("x_m"), numbers.at("y_m"), numbers.at("z_m"));
    registry.markers.push_back({id, position_m, wrap_angle(radians(numbers.at("yaw_deg")))});
    numbers.finish();
  }
  return registry;
}

std::optional<int> repeated_id(const MarkerRegistry& registry) {
  std::set<int> seen;
  for (const RegisteredMarker& marker : registry.markers) {
    if (!seen.insert(marker.id).second) return marker.id;
  }
  return std::nullopt;
}

}  // namespace lodestar
