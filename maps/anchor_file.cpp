#include <cmath>
#include <fmt/format.h>

#include "maps/anchors.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

constexpr const char* format_name = "lodestar-anchors";
constexpr double farthest_m = 1e5;

double read_sigma(StrictYaml& yaml, const std::string& key) {
  const double sigma = yaml.number(key);
  if (!(sigma > 0.0)) yaml.refuse(key, fmt::format("{}", sigma), "a standard deviation above 0");
  return sigma;
}

Vec2 read_position(StrictYaml& yaml) {
  return {yaml.number("x_m", -farthest_m, farthest_m), yaml.number("y_m", -farthest_m, farthest_m)};
}

std::optional<AnchorYaw> read_yaw(StrictYaml& yaml) {
  if (!yaml.has("yaw_deg") && !yaml.has("sigma_deg")) return std::nullopt;
  const double yaw_rad = wrap_angle(radians(yaml.number("yaw_deg")));
  return AnchorYaw{yaw_rad, radians(read_sigma(yaml, "sigma_deg"))};
}

int read_id(StrictYaml& yaml, const std::string& key, double value) {
  if (value != std::floor(value) || value < 0.0 || value >= marker_id_count)
    yaml.refuse(key, fmt::format("{}", value), fmt::format("IDs in 0..{}", marker_id_count - 1));
  return static_cast<int>(value);
}

DistanceAnchor read_distance(StrictYaml& yaml) {
  const std::vector<double> ids = yaml.numbers("between", 2);
  DistanceAnchor anchor{.first = read_id(yaml, "between", ids[0]),
                        .second = read_id(yaml, "between", ids[1])};
  if (anchor.first == anchor.second)
    yaml.refuse("between", fmt::format("{} twice", anchor.first), "two different IDs");
  anchor.distance_m = yaml.number("distance_m");
  if (!(anchor.distance_m > 0.0))
    yaml.refuse("distance_m", fmt::format("{}", anchor.distance_m), "a distance above 0");
  anchor.sigma_m = read_sigma(yaml, "sigma_m");
  return anchor;
}

RobotAnchor read_robot(StrictYaml& yaml) {
  RobotAnchor anchor{.at_s = yaml.number("robot_at_s")};
  if (yaml.has("log")) anchor.log = yaml.text("log");
  anchor.position_m = read_position(yaml);
  anchor.sigma_m = read_sigma(yaml, "sigma_m");
  anchor.yaw = read_yaw(yaml);
  return anchor;
}

MarkerAnchor read_marker(StrictYaml& yaml) {
  MarkerAnchor anchor{.id = yaml.integer("marker", 0, marker_id_count - 1)};
  anchor.position_m = read_position(yaml);
  anchor.sigma_m = read_sigma(yaml, "sigma_m");
  anchor.yaw = read_yaw(yaml);
  return anchor;
}

PrintScale read_print_scale(StrictYaml& yaml) {
  constexpr double least = 0.5;  // farther off is a marker of another size
  constexpr double most = 2.0;
  const double scale = yaml.number("print_scale", least, most);
  return {scale, read_sigma(yaml, "sigma")};
}

}  // namespace

std::string to_string(const Anchor& anchor) {
  struct Words {
    std::string operator()(const MarkerAnchor& a) const { return fmt::format("marker {}", a.id); }
    std::string operator()(const RobotAnchor& a) const {
      return fmt::format("robot at {} s{}", a.at_s, a.log.empty() ? "" : " of " + a.log);
    }
    std::string operator()(const DistanceAnchor& a) const {
      return fmt::format("distance between {} and {}", a.first, a.second);
    }
  };
  return std::visit(Words{}, anchor.what);
}

Anchors load_anchors(const std::filesystem::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  const std::string format = yaml.text("format");
  if (format != format_name) yaml.refuse("format", "'" + format + "'", fmt::format("'{}'", format_name));
  (void)yaml.integer("version", 1, 1);
  Anchors anchors;
  bool has_scale = false;
  for (StrictYaml& entry : yaml.list_of_mappings("anchors")) {
    const int line = entry.line();
    if (entry.has("marker")) {
      anchors.anchors.push_back({read_marker(entry), line});
    } else if (entry.has("robot_at_s")) {
      anchors.anchors.push_back({read_robot(entry), line});
    } else if (entry.has("between")) {
      anchors.anchors.push_back({read_distance(entry), line});
    } else if (entry.has("print_scale")) {
      if (has_scale) throw InputError(file, line, "print_scale again", "one print_scale");
      anchors.print_scale = read_print_scale(entry);
      has_scale = true;
    } else {
      throw InputError(file, line, "an anchor of no known kind",
                       "marker, robot_at_s, between or print_scale");
    }
    entry.finish();
  }
  yaml.finish();
  return anchors;
}

}  // namespace lodestar
