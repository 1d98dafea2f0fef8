#include "app/viewers/foxglove_messages.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "app/common/base64.hpp"
#include "app/common/rounding.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

using Json = MessageJson;

constexpr const char* map_frame = "map";
constexpr const char* base_frame = "base_link";
constexpr const char* camera_frame = "camera";

Json vector_json(const Vec3& v) {
  constexpr double per_m = 1e6;
  return {{"x", rounded(v.x(), per_m)}, {"y", rounded(v.y(), per_m)}, {"z", rounded(v.z(), per_m)}};
}

Json rotation_json(const Eigen::Matrix3d& rotation) {
  constexpr double per_unit = 1e9;
  const Eigen::Quaterniond q(rotation);
  return {{"x", rounded(q.x(), per_unit)},
          {"y", rounded(q.y(), per_unit)},
          {"z", rounded(q.z(), per_unit)},
          {"w", rounded(q.w(), per_unit)}};
}

Json color_json(double r, double g, double b, double a) {
  return {{"r", r}, {"g", g}, {"b", b}, {"a", a}};
}

/// A scene entity without shapes yet; it stays until one with the same ID replaces it.
Json entity_json(Stamp stamp, const char* frame, const std::string& id) {
  return {{"timestamp", time_json(stamp)},  {"frame_id", frame},      {"id", id},
          {"lifetime", time_json(Stamp())}, {"frame_locked", true},   {"metadata", Json::array()},
          {"arrows", Json::array()},        {"cubes", Json::array()}, {"spheres", Json::array()},
          {"cylinders", Json::array()},     {"lines", Json::array()}, {"triangles", Json::array()},
          {"texts", Json::array()},         {"models", Json::array()}};
}

Json scene_json(Json entities) {
  return {{"deletions", Json::array()}, {"entities", std::move(entities)}};
}

Json disc_json(const Eigen::Isometry3d& pose, const Vec3& size_m, Json color) {
  return {{"pose", pose_json(pose)},
          {"size", vector_json(size_m)},
          {"bottom_scale", 1.0},
          {"top_scale", 1.0},
          {"color", std::move(color)}};
}

/// A closed line at this height.
Json outline_json(const std::vector<Vec2>& corners_m, double height_m) {
  constexpr int line_loop = 1;
  Json points = Json::array();
  for (const Vec2& corner : corners_m) points.push_back(vector_json({corner.x(), corner.y(), height_m}));
  return {{"type", line_loop},           {"pose", pose_json(Eigen::Isometry3d::Identity())},
          {"thickness", 0.03},           {"scale_invariant", false},
          {"points", std::move(points)}, {"color", color_json(0.2, 0.6, 0.9, 1.0)},
          {"colors", Json::array()},     {"indices", Json::array()}};
}

Json marker_entity(Stamp stamp, const MarkerRegistry& registry, const RegisteredMarker& marker,
                   bool distrusted) {
  constexpr double plate_m = marker_grid_size * marker_pitch_m;
  constexpr double middle_m = 0.5 * (marker_grid_size - 1) * marker_pitch_m;
  Eigen::Isometry3d pose = map_from_marker(registry, marker);
  pose.translate(Vec3(middle_m, middle_m, 0.0));
  Json entity = entity_json(stamp, map_frame, "marker " + std::to_string(marker.id));
  entity["cubes"].push_back(
      {{"pose", pose_json(pose)},
       {"size", vector_json({plate_m, plate_m, 0.005})},
       {"color", distrusted ? color_json(0.8, 0.1, 0.1, 1.0) : color_json(0.1, 0.3, 0.7, 1.0)}});
  entity["texts"].push_back({{"pose", pose_json(pose)},
                             {"billboard", true},
                             {"font_size", 0.12},
                             {"scale_invariant", false},
                             {"color", color_json(1.0, 1.0, 1.0, 1.0)},
                             {"text", std::to_string(marker.id)}});
  return entity;
}

const char* distortion_name(Distortion distortion) {
  if (distortion == Distortion::rational_polynomial) return "rational_polynomial";
  if (distortion == Distortion::equidistant) return "kannala_brandt";
  return "plumb_bob";
}

/// OpenCV's order; a plumb bob has five, a fisheye four.
Json coefficients_json(const CameraModel& camera) {
  const std::size_t count = camera.distortion == Distortion::rational_polynomial ? 8
                            : camera.distortion == Distortion::equidistant       ? 4
                                                                                 : 5;
  return std::vector<double>(camera.coefficients.begin(),
                             camera.coefficients.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

Json time_json(Stamp stamp) {
  constexpr std::int64_t per_second = 1'000'000'000;
  const std::int64_t ns = std::max<std::int64_t>(stamp.time_since_epoch().count(), 0);
  return {{"sec", ns / per_second}, {"nsec", ns % per_second}};
}

Json pose_json(const Eigen::Isometry3d& pose) {
  return {{"position", vector_json(pose.translation())}, {"orientation", rotation_json(pose.linear())}};
}

Json transform_message(Stamp stamp, const char* parent, const char* child,
                       const Eigen::Isometry3d& parent_from_child) {
  return {{"timestamp", time_json(stamp)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", vector_json(parent_from_child.translation())},
          {"rotation", rotation_json(parent_from_child.linear())}};
}

Json pose_message(Stamp stamp, const Eigen::Isometry3d& map_from_base) {
  return {{"timestamp", time_json(stamp)}, {"frame_id", map_frame}, {"pose", pose_json(map_from_base)}};
}

Json path_message(Stamp stamp, const Path& path) {
  Json poses = Json::array();
  double yaw_rad = 0.0;
  for (std::size_t i = 0; i < path.waypoints_m.size(); ++i) {
    const Vec2& at = path.waypoints_m[i];
    if (i + 1 < path.waypoints_m.size()) yaw_rad = heading_between(at, path.waypoints_m[i + 1]);
    poses.push_back(pose_json(lifted({at, yaw_rad})));
  }
  return {{"timestamp", time_json(stamp)}, {"frame_id", map_frame}, {"poses", poses}};
}

Json grid_message(Stamp stamp, const OccupancyMap& map) {
  constexpr int int8 = 2;
  const std::string cells(map.cells.begin(), map.cells.end());
  return {{"timestamp", time_json(stamp)},
          {"frame_id", map_frame},
          {"pose", pose_json(lifted(map.map_from_grid))},
          {"column_count", map.columns},
          {"cell_size", {{"x", map.resolution_m}, {"y", map.resolution_m}}},
          {"row_stride", map.columns},
          {"cell_stride", 1},
          {"fields", {{{"name", "occupancy"}, {"offset", 0}, {"type", int8}}}},
          {"data", base64(cells)}};
}

Json markers_message(Stamp stamp, const MarkerRegistry& registry, const std::vector<int>& distrusted) {
  Json entities = Json::array();
  for (const RegisteredMarker& marker : registry.markers) {
    const bool is_bad = std::ranges::find(distrusted, marker.id) != distrusted.end();
    entities.push_back(marker_entity(stamp, registry, marker, is_bad));
  }
  Json scene = scene_json(std::move(entities));
  constexpr int all = 1;
  scene["deletions"].push_back({{"timestamp", time_json(stamp)}, {"type", all}, {"id", ""}});
  return scene;
}

Json robot_message(const PoseEstimate& estimate, const RobotBody& robot) {
  constexpr double height_m = 0.02;
  constexpr double sigmas = 3.0;
  const Stamp stamp = estimate.stamp;
  Json body = entity_json(stamp, base_frame, "robot");
  if (robot.outline_m.empty()) {
    body["cylinders"].push_back(disc_json(lifted({}, 0.5 * height_m),
                                          {2.0 * robot.radius_m, 2.0 * robot.radius_m, height_m},
                                          color_json(0.2, 0.6, 0.9, 0.5)));
  } else {
    body["lines"].push_back(outline_json(robot.outline_m, height_m));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(estimate.covariance.topLeftCorner<2, 2>());
  const Vec2 sigma_m = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Vec2 axis = solver.eigenvectors().col(0);
  const Pose2 ellipse{estimate.map_from_base.position_m, heading_of(axis)};
  Json uncertainty = entity_json(stamp, map_frame, "three standard deviations");
  uncertainty["cylinders"].push_back(disc_json(lifted(ellipse, height_m),
                                               {2.0 * sigmas * sigma_m.x(), 2.0 * sigmas * sigma_m.y(), 0.01},
                                               color_json(0.9, 0.4, 0.1, 0.6)));
  return scene_json(Json::array({std::move(body), std::move(uncertainty)}));
}

Json calibration_message(Stamp stamp, const CameraModel& camera) {
  const double fx = camera.fx_px;
  const double fy = camera.fy_px;
  const double cx = camera.cx_px;
  const double cy = camera.cy_px;
  return {{"timestamp", time_json(stamp)},
          {"frame_id", camera_frame},
          {"width", camera.width_px},
          {"height", camera.height_px},
          {"distortion_model", distortion_name(camera.distortion)},
          {"D", coefficients_json(camera)},
          {"K", {fx, 0, cx, 0, fy, cy, 0, 0, 1}},
          {"R", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
          {"P", {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0}}};
}

Json picture_message(Stamp stamp, const std::string& jpeg) {
  return {{"timestamp", time_json(stamp)},
          {"frame_id", camera_frame},
          {"data", base64(jpeg)},
          {"format", "jpeg"}};
}

Json log_message(Stamp stamp, LogLevel level, const std::string& words) {
  return {{"timestamp", time_json(stamp)},
          {"level", static_cast<int>(level)},
          {"message", words},
          {"name", "lodestar"},
          {"file", ""},
          {"line", 0}};
}

}  // namespace lodestar
