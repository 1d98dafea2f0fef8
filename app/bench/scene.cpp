#include "app/bench/scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "maps/paper_camera.hpp"

namespace lodestar {
namespace {

constexpr int groups_aside = 3;           // groups stand on a square grid
constexpr double between_groups_m = 7.0;  // more than a camera sees from 4 m
constexpr double triangle_radius_m = 0.55;

int some_id_of_nine_dots(const MarkerRegistry& others, Random& random) {
  constexpr int coded_dots = 6;
  while (true) {
    const auto id = static_cast<int>(random.below(marker_id_count));
    const bool is_new =
        std::ranges::none_of(others.markers, [&](const RegisteredMarker& other) { return other.id == id; });
    if (is_new && std::popcount(static_cast<unsigned>(id)) == coded_dots) return id;
  }
}

/// A marker whose grid is centred at this point.
RegisteredMarker marker_about(int id, const Vec3& middle_m, double yaw_rad) {
  RegisteredMarker marker{.id = id, .yaw_rad = yaw_rad};
  const Vec3 from_o = map_from_marker({}, marker) * marker_middle;
  marker.position_m = middle_m - from_o;
  return marker;
}

Vec3 center_in_map(const MarkerRegistry& registry, std::size_t marker) {
  return map_from_marker(registry, registry.markers[marker]) * marker_middle;
}

/// A dark sheet that covers this share of the marker from one of its sides.
PrintedSquare sheet_over(const MarkerRegistry& registry, std::size_t marker, double share, Random& random) {
  constexpr double sheet_m = 0.4;
  constexpr double sheet_gray = 25.0;
  PrintedSquare sheet{.side_m = sheet_m, .modules = 1, .gray = {sheet_gray}};
  const Eigen::Rotation2Dd side(0.5 * std::numbers::pi * static_cast<double>(random.below(4)));
  const Vec2 offset = side * Vec2(0.5 * sheet_m + (0.5 - share) * marker_side_m, 0.0);
  const Vec3 place = marker_middle + Vec3(offset.x(), offset.y(), 0.0);
  sheet.map_from_square = map_from_marker(registry, registry.markers[marker]) * Eigen::Translation3d(place);
  return sheet;
}

}  // namespace

CameraModel bench_camera() {
  return paper_camera();
}

CameraModel camera_of(const BenchScene& scene) {
  CameraModel camera = bench_camera();
  if (!scene.megapixel) return camera;
  camera.width_px = 1280;
  camera.height_px = 1024;
  camera.fx_px *= 2.0;
  camera.fy_px *= 2.0;
  camera.cx_px = 639.5;
  camera.cy_px = 511.5;
  return camera;
}

MarkerRegistry bench_registry(const BenchScene& scene, Random random) {
  MarkerRegistry registry;
  for (int group = 0; group < groups_aside * groups_aside; ++group) {
    const int row = group / groups_aside;
    const Vec3 middle(between_groups_m * (group % groups_aside), between_groups_m * row, scene.height_m);
    for (int i = 0; i < scene.markers; ++i) {
      const double direction = 2.0 * std::numbers::pi * i / scene.markers + 0.5 * std::numbers::pi;
      const double radius_m = scene.markers > 1 ? triangle_radius_m : 0.0;
      const Vec3 offset(radius_m * std::cos(direction), radius_m * std::sin(direction), 0.0);
      const int id = some_id_of_nine_dots(registry, random);
      const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
      registry.markers.push_back(marker_about(id, middle + offset, yaw));
    }
  }
  return registry;
}

SimulatedCameraOptions light_of(const BenchScene& scene) {
  SimulatedCameraOptions light;
  light.dot_gray *= scene.light;
  light.background_gray *= scene.light;
  light.texture_gray = scene.light * scene.texture_gray;
  light.blur_sigma_px = scene.blur_sigma_px;
  light.read_noise_gray = scene.noise_gray;
  light.shot_noise_gray_at_255 = 0.0;
  light.dot_place_sigma_m = 0.0;
  light.tubes = light.lamps = light.glints = false;
  return light;
}

BenchView some_view(const BenchScene& scene, const MarkerRegistry& registry, Random& random) {
  BenchView view;
  const std::size_t groups = registry.markers.size() / static_cast<std::size_t>(scene.markers);
  view.first_marker = random.below(groups) * static_cast<std::size_t>(scene.markers);

  const double towards = random.uniform(-std::numbers::pi, std::numbers::pi);
  view.tilt = Eigen::AngleAxisd(scene.tilt_rad, Vec3(std::cos(towards), std::sin(towards), 0.0)).matrix();
  // A group of three must fit the image, so its yaw varies little; a single marker's yaw is random already.
  const double yaw =
      scene.markers > 1 ? random.uniform(-0.2, 0.2) : random.uniform(-std::numbers::pi, std::numbers::pi);
  const Eigen::Matrix3d heading = rotation_from({0.0, 0.0, yaw});
  view.map_from_camera.linear() = heading * view.tilt;

  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < scene.markers; ++i)
    middle += center_in_map(registry, view.first_marker + static_cast<std::size_t>(i)) / scene.markers;
  constexpr double few_pixels_m = 0.01;
  const double aside = random.below(2) == 0 ? scene.off_axis_m : -scene.off_axis_m;
  const Vec3 from_marker = heading * Vec3(aside + random.uniform(-few_pixels_m, few_pixels_m),
                                          random.uniform(-few_pixels_m, few_pixels_m), 0.0);
  const Vec3 axis = view.map_from_camera.linear().col(2);
  view.map_from_camera.translation() = middle + from_marker - axis * (scene.height_m / axis.z());
  if (scene.covered > 0.0)
    view.covers.push_back(sheet_over(registry, view.first_marker, scene.covered, random));
  return view;
}

}  // namespace lodestar
