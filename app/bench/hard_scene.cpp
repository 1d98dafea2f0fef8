#include "app/bench/hard_scene.hpp"

#include <array>
#include <cmath>

namespace lodestar {
namespace {

/// One of the direction dots O, X and Y, in the marker frame.
Vec3 some_direction_dot(Random& random) {
  constexpr std::array cells{cell_of_o, cell_of_x, cell_of_y};
  const Vec2 place = cell_in_marker(cells.at(random.below(cells.size())));
  return {place.x(), place.y(), 0.0};
}

double some_angle(Random& random) {
  return random.uniform(-std::numbers::pi, std::numbers::pi);
}

/// A patch of sunlight on the ceiling, as bright as a dot or brighter.
PrintedSquare some_patch_of_sun(const HardScene& scene, Random& random) {
  PrintedSquare patch{
      .side_m = random.uniform(0.05, 0.8), .modules = 1, .gray = {random.uniform(120.0, 400.0)}};
  patch.map_from_square =
      Eigen::Translation3d(random.uniform(-scene.reach_m, scene.reach_m),
                           random.uniform(-scene.reach_m, scene.reach_m), scene.ceiling_m) *
      Eigen::AngleAxisd(some_angle(random), Vec3::UnitZ()) *
      Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX());
  return patch;
}

/// A sheet with this side length, centred at a point of a marker.
PrintedSquare sheet_at(const Eigen::Isometry3d& map_from_marker, const Vec3& place, double side_m,
                       Random& random) {
  PrintedSquare sheet{.side_m = side_m, .modules = 1, .gray = {random.uniform(0.0, 60.0)}};
  sheet.map_from_square =
      map_from_marker * Eigen::Translation3d(place) * Eigen::AngleAxisd(some_angle(random), Vec3::UnitZ());
  return sheet;
}

Eigen::Isometry3d camera_that_sees(const Vec3& point, const Vec2& at_px, const Eigen::Matrix3d& rotation,
                                   double depth_m) {
  const CameraModel camera = bench_camera();
  const Vec2 pinhole((at_px.x() - camera.cx_px) / camera.fx_px, (at_px.y() - camera.cy_px) / camera.fy_px);
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  map_from_camera.linear() = rotation;
  const Vec3 ray = rotation * pinhole.homogeneous();
  map_from_camera.translation() = point - ray * (depth_m / ray.z());
  return map_from_camera;
}

/// Any heading, and a tilt of up to 10 degrees.
Eigen::Matrix3d some_tilt(Random& random) {
  constexpr double most_tilt = radians(10.0);
  const Eigen::Matrix3d tilt =
      rotation_from({random.uniform(-most_tilt, most_tilt) / std::numbers::sqrt2,
                     random.uniform(-most_tilt, most_tilt) / std::numbers::sqrt2, 0.0});
  return rotation_from({0.0, 0.0, some_angle(random)}) * tilt;
}

BenchView view_of_ceiling(const HardScene& scene, const Eigen::Matrix3d& rotation, Random& random) {
  const Vec3 looked_at(random.uniform(-scene.reach_m, scene.reach_m),
                       random.uniform(-scene.reach_m, scene.reach_m), scene.ceiling_m);
  const CameraModel camera = bench_camera();
  BenchView view;
  view.map_from_camera = camera_that_sees(looked_at, {camera.cx_px, camera.cy_px}, rotation, scene.ceiling_m);
  return view;
}

/// A direction dot occluded wholly or in part by a sheet, or cut by the image border, within 1.5 dot radii of
/// its centre.
BenchView view_without_a_direction_dot(const HardScene& scene, const Eigen::Matrix3d& rotation,
                                       Random& random) {
  const std::size_t marker = random.below(scene.registry.markers.size());
  const Eigen::Isometry3d map_from_this = map_from_marker(scene.registry, scene.registry.markers[marker]);
  const Vec3 dot = some_direction_dot(random);
  BenchView view{.first_marker = marker};
  const CameraModel camera = bench_camera();
  const double dot_px = camera.fx_px * marker_dot_radius_m / scene.ceiling_m;
  if (random.below(2) == 0) {
    const Vec2 anywhere(random.uniform(120.0, 520.0), random.uniform(120.0, 360.0));
    view.map_from_camera = camera_that_sees(map_from_this * dot, anywhere, rotation, scene.ceiling_m);
    const double side_m = random.uniform(0.015, 0.04);
    const Vec3 off(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0.0);
    view.covers.push_back(sheet_at(map_from_this, dot + off, side_m, random));
    return view;
  }
  const double inside_px = random.uniform(-1.5, 1.5) * dot_px;
  const double along = random.uniform();
  const std::array<Vec2, 4> at_borders{Vec2(inside_px, 480.0 * along), Vec2(639.0 - inside_px, 480.0 * along),
                                       Vec2(640.0 * along, inside_px),
                                       Vec2(640.0 * along, 479.0 - inside_px)};
  view.map_from_camera =
      camera_that_sees(map_from_this * dot, at_borders.at(random.below(4)), rotation, scene.ceiling_m);
  return view;
}

/// Any ceiling, up to as bright as in the table of ceilings: structure is what is taken for a marker.
void make_empty(HardScene& scene, Random& random) {
  scene.markers_hang = false;
  scene.light.ceiling = all_ceiling_kinds.at(random.below(all_ceiling_kinds.size()));
  scene.light.background_gray = random.uniform(10.0, 140.0);
}

}  // namespace

MarkerRegistry some_markers(int aside, double spacing_m, double ceiling_m, Random& random) {
  MarkerRegistry registry;
  constexpr int id_step = 797;  // coprime to 4096: no ID comes twice
  const auto first_id = static_cast<int>(random.below(marker_id_count));
  for (int i = 0; i < aside * aside; ++i) {
    const int row = i / aside;
    const Vec2 place(i % aside - 0.5 * (aside - 1), row - 0.5 * (aside - 1));
    const Vec2 shift(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
    const Vec2 at = spacing_m * place + shift;
    registry.markers.push_back({.id = (first_id + i * id_step) % marker_id_count,
                                .position_m = {at.x(), at.y(), ceiling_m},
                                .yaw_rad = some_angle(random)});
  }
  return registry;
}

HardScene some_hard_scene(HardFrames kind, Random& random) {
  HardScene scene;
  scene.ceiling_m = random.uniform(1.5, 4.0);
  const double brightness = random.uniform(0.4, 1.0);
  scene.light.dot_gray *= brightness;
  scene.light.background_gray = brightness * random.uniform(10.0, 110.0);
  scene.light.blur_sigma_px = random.uniform(0.3, 1.5);
  scene.light.read_noise_gray = random.uniform(1.0, 6.0);
  if (kind == HardFrames::direction_dot_lost) {
    scene.registry = some_markers(4, 5.0, scene.ceiling_m, random);
    scene.light.tubes = scene.light.lamps = scene.light.glints = false;
    return scene;
  }
  scene.registry = some_markers(5, 0.9, scene.ceiling_m, random);
  if (kind == HardFrames::empty) make_empty(scene, random);
  constexpr int patches = 6;
  for (int i = 0; i < patches; ++i) scene.sun.push_back(some_patch_of_sun(scene, random));
  return scene;
}

BenchView some_tilted_view(const HardScene& scene, Random& random) {
  return view_of_ceiling(scene, some_tilt(random), random);
}

BenchView some_hard_view(HardFrames kind, const HardScene& scene, Random& random) {
  const Eigen::Matrix3d rotation = some_tilt(random);
  if (kind == HardFrames::direction_dot_lost) return view_without_a_direction_dot(scene, rotation, random);

  BenchView view = view_of_ceiling(scene, rotation, random);
  if (kind == HardFrames::adverse && random.below(2) == 0) {
    const RegisteredMarker& marker = scene.registry.markers[random.below(scene.registry.markers.size())];
    const Vec3 off(random.uniform(-0.12, 0.12), random.uniform(-0.12, 0.12), 0.0);
    view.covers.push_back(sheet_at(map_from_marker(scene.registry, marker), marker_middle + off,
                                   random.uniform(0.02, 0.2), random));
  }
  return view;
}

}  // namespace lodestar
