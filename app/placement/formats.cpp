#include "app/placement/formats.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/json_text.hpp"
#include "app/placement/poses.hpp"
#include "maps/registry_text.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

Eigen::Isometry3d pose_at_o(const MarkerRegistry& registry, const RegisteredMarker& marker) {
  return map_from_frame(registry, marker, MarkerFrame::at_o);
}

std::string csv_text(const MarkerRegistry& registry) {
  std::string text = "id,x,y,z,yaw_deg\n";
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = pose_at_o(registry, marker);
    const Vec3 at = pose.translation();
    text +=
        fmt::format("{},{},{},{},{}\n", marker.id, at.x(), at.y(), at.z(), degrees(flattened(pose).yaw_rad));
  }
  return text;
}

std::string stargazer_text(const MarkerRegistry& registry) {
  std::string text = "# metres, angle-axis in radians; the origin of a landmark is its dot O\nLandmarks:";
  if (registry.markers.empty()) text += " []";
  text += "\n";
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = pose_at_o(registry, marker);
    const Vec3 at = pose.translation();
    const Eigen::AngleAxisd turn(pose.linear());
    const Vec3 r = turn.angle() * turn.axis();
    text += fmt::format("  - {{HexID: 0x{:04x}, x: {}, y: {}, z: {}, rx: {}, ry: {}, rz: {}}}\n", marker.id,
                        at.x(), at.y(), at.z(), r.x(), r.y(), r.z());
  }
  return text;
}

std::string apriltag_text(const MarkerRegistry& registry) {
  ordered_json tags = ordered_json::array();
  Vec2 far = Vec2::Zero();
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = map_from_frame(registry, marker, MarkerFrame::out_of_the_center);
    const Vec3 at = pose.translation();
    const Eigen::Quaterniond turn(pose.linear());
    far = far.cwiseMax(at.head<2>());
    tags.push_back(
        {{"ID", marker.id},
         {"pose",
          {{"translation", {{"x", at.x()}, {"y", at.y()}, {"z", at.z()}}},
           {"rotation",
            {{"quaternion", {{"W", turn.w()}, {"X", turn.x()}, {"Y", turn.y()}, {"Z", turn.z()}}}}}}}});
  }
  const ordered_json layout{{"tags", tags}, {"field", {{"length", far.x()}, {"width", far.y()}}}};
  return json_document(layout);
}

std::string fiducial_slam_text(const MarkerRegistry& registry) {
  std::string text;
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = map_from_frame(registry, marker, MarkerFrame::at_center);
    const Vec3 at = pose.translation();
    const RollPitchYaw turn = angles_of(pose.linear());
    text += fmt::format("{} {} {} {} {} {} {} 0 1\n", marker.id, at.x(), at.y(), at.z(),
                        degrees(turn.roll_rad), degrees(turn.pitch_rad), degrees(turn.yaw_rad));
  }
  return text;
}

std::string geojson_text(const MarkerRegistry& registry) {
  ordered_json features = ordered_json::array();
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = pose_at_o(registry, marker);
    const Vec3 at = pose.translation();
    features.push_back(
        {{"type", "Feature"},
         {"properties", {{"id", marker.id}, {"frame", "map"}, {"yaw_deg", degrees(flattened(pose).yaw_rad)}}},
         {"geometry", {{"type", "Point"}, {"coordinates", {at.x(), at.y(), at.z()}}}}});
  }
  const ordered_json collection{{"type", "FeatureCollection"}, {"features", features}};
  return json_document(collection);
}

}  // namespace

const std::vector<std::string>& marker_format_names() {
  static const std::vector<std::string> names{"lodestar", "csv",           "stargazer",
                                              "apriltag", "fiducial_slam", "geojson"};
  return names;
}

std::optional<MarkerFormat> marker_format_named(std::string_view name) {
  const std::vector<std::string>& names = marker_format_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<MarkerFormat>(found - names.begin());
}

std::optional<MarkerFormat> guess_marker_format(const std::filesystem::path& file, std::string_view text) {
  const std::string extension = file.extension().string();
  if (extension == ".csv") return MarkerFormat::csv;
  if (extension == ".txt") return MarkerFormat::fiducial_slam;
  if (extension == ".geojson") return MarkerFormat::geojson;
  if (extension == ".json") {
    return text.find("FeatureCollection") == std::string_view::npos ? MarkerFormat::apriltag
                                                                    : MarkerFormat::geojson;
  }
  if (extension == ".yaml" || extension == ".yml") {
    return text.find("Landmarks:") == std::string_view::npos ? MarkerFormat::lodestar
                                                             : MarkerFormat::stargazer;
  }
  return std::nullopt;
}

std::string markers_text(const MarkerRegistry& registry, MarkerFormat format) {
  switch (format) {
    case MarkerFormat::lodestar:
      return registry_text(registry);
    case MarkerFormat::csv:
      return csv_text(registry);
    case MarkerFormat::stargazer:
      return stargazer_text(registry);
    case MarkerFormat::apriltag:
      return apriltag_text(registry);
    case MarkerFormat::fiducial_slam:
      return fiducial_slam_text(registry);
    case MarkerFormat::geojson:
      return geojson_text(registry);
  }
  return "";
}

}  // namespace lodestar
