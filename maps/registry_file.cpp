#include <fmt/format.h>
#include <map>

#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/marker_registry.hpp"
#include "maps/registry_text.hpp"
#include "maps/strict_yaml.hpp"
#include "maps/tidy.hpp"

namespace lodestar {
namespace {

constexpr const char* format_name = "lodestar-markers";

Pose2 read_alignment(StrictYaml yaml) {
  const double x_m = yaml.number("x_m");
  const double y_m = yaml.number("y_m");
  const double yaw_deg = yaml.number("yaw_deg");
  yaml.finish();
  return {{x_m, y_m}, wrap_angle(radians(yaw_deg))};
}

/// One of the two alone leaves the other at 0.
std::optional<MarkerSigma> read_sigma(StrictYaml& yaml) {
  if (!yaml.has("sigma_m") && !yaml.has("sigma_deg")) return std::nullopt;
  constexpr double most_m = 10.0;
  constexpr double most_deg = 180.0;
  MarkerSigma sigma;
  if (yaml.has("sigma_m")) sigma.position_m = yaml.number("sigma_m", 0.0, most_m);
  if (yaml.has("sigma_deg")) sigma.yaw_rad = radians(yaml.number("sigma_deg", 0.0, most_deg));
  return sigma;
}

RegisteredMarker read_marker(StrictYaml& yaml) {
  RegisteredMarker marker;
  marker.id = yaml.integer("id", 0, marker_id_count - 1);
  marker.position_m = {yaml.number("x_m"), yaml.number("y_m"), yaml.number("z_m")};
  marker.yaw_rad = wrap_angle(radians(yaml.number("yaw_deg")));
  marker.sigma = read_sigma(yaml);
  marker.line = yaml.line();
  yaml.finish();
  return marker;
}

double tidy_degrees(double angle_rad) {
  return tidy(degrees(angle_rad));
}

std::string sigma_text(const std::optional<MarkerSigma>& sigma) {
  if (!sigma) return "";
  return fmt::format(", sigma_m: {}, sigma_deg: {}", sigma->position_m, tidy_degrees(sigma->yaw_rad));
}

MarkerRegistry read_registry(StrictYaml yaml) {
  const std::string format = yaml.text("format");
  if (format != format_name) yaml.refuse("format", "'" + format + "'", fmt::format("'{}'", format_name));
  (void)yaml.integer("version", 1, 1);

  MarkerRegistry registry;
  registry.map_from_registry = read_alignment(yaml.mapping("alignment"));
  for (StrictYaml& entry : yaml.list_of_mappings("markers")) registry.markers.push_back(read_marker(entry));
  yaml.finish();
  return registry;
}

MarkerRegistry require_unique_ids(MarkerRegistry registry, const std::filesystem::path& file) {
  std::map<int, int> line_of_id;
  for (const RegisteredMarker& marker : registry.markers) {
    const auto [first, is_new] = line_of_id.emplace(marker.id, marker.line);
    if (is_new) continue;
    throw InputError(file, marker.line, fmt::format("marker {} again", marker.id),
                     fmt::format("each ID once (first in line {})", first->second));
  }
  return registry;
}

}  // namespace

MarkerRegistry load_registry_draft(const std::filesystem::path& file) {
  return read_registry(StrictYaml::load(file));
}

MarkerRegistry load_registry(const std::filesystem::path& file) {
  return require_unique_ids(load_registry_draft(file), file);
}

MarkerRegistry parse_registry(const std::string& text, const std::filesystem::path& file) {
  return require_unique_ids(read_registry(StrictYaml::parse(text, file)), file);
}

std::string registry_text(const MarkerRegistry& registry) {
  const Pose2& alignment = registry.map_from_registry;
  std::string text =
      fmt::format("format: {}\nversion: 1\nalignment: {{x_m: {}, y_m: {}, yaw_deg: {}}}\nmarkers:{}\n",
                  format_name, alignment.position_m.x(), alignment.position_m.y(),
                  tidy_degrees(alignment.yaw_rad), registry.markers.empty() ? " []" : "");
  for (const RegisteredMarker& marker : registry.markers) {
    text += fmt::format("  - {{id: {}, x_m: {}, y_m: {}, z_m: {}, yaw_deg: {}{}}}\n", marker.id,
                        marker.position_m.x(), marker.position_m.y(), marker.position_m.z(),
                        tidy_degrees(marker.yaw_rad), sigma_text(marker.sigma));
  }
  return text;
}

void save_registry(const MarkerRegistry& registry, const std::filesystem::path& file) {
  write_file_atomically(file, registry_text(registry));
}

}  // namespace lodestar
