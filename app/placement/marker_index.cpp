#include "app/placement/marker_index.hpp"

#include <algorithm>
#include <cmath>

#include "maps/marker.hpp"

namespace lodestar {
namespace {

MarkerInMap in_map(const MarkerRegistry& registry, const RegisteredMarker& registered) {
  const Eigen::Isometry3d pose = map_from_marker(registry, registered);
  MarkerInMap marker{.middle = pose * Vec3(1.5 * marker_pitch_m, 1.5 * marker_pitch_m, 0.0), .dots = {}};
  for (const GridCell cell : dots_of(registered.id)) {
    const Vec2 at = cell_in_marker(cell);
    marker.dots.push_back(pose * Vec3(at.x(), at.y(), 0.0));
  }
  return marker;
}

/// The image's outermost pixels.
std::vector<Vec2> border_of(const CameraModel& camera) {
  std::vector<Vec2> border;
  for (int x = 0; x < camera.width_px; ++x)
    for (const double y : {-0.5, camera.height_px - 0.5}) border.emplace_back(x, y);
  for (int y = 0; y < camera.height_px; ++y)
    for (const double x : {-0.5, camera.width_px - 0.5}) border.emplace_back(x, y);
  return border;
}

}  // namespace

MarkerIndex::MarkerIndex(const MarkerRegistry& registry, std::optional<double> reach_m) : side_m_(reach_m) {
  for (const RegisteredMarker& registered : registry.markers)
    markers_.push_back(in_map(registry, registered));
  for (std::size_t i = 0; i < markers_.size(); ++i)
    in_square_[square_of(markers_[i].middle.head<2>())].push_back(i);
}

MarkerIndex::Square MarkerIndex::square_of(const Vec2& position_m) const {
  if (!side_m_) return {};
  return {static_cast<int>(std::floor(position_m.x() / *side_m_)),
          static_cast<int>(std::floor(position_m.y() / *side_m_))};
}

std::vector<const MarkerInMap*> MarkerIndex::about(const Vec2& position_m) const {
  const Square middle = square_of(position_m);
  std::vector<std::size_t> near;
  for (int column = middle.first - 1; column <= middle.first + 1; ++column) {
    for (int row = middle.second - 1; row <= middle.second + 1; ++row) {
      const auto found = in_square_.find({column, row});
      if (found != in_square_.end()) near.insert(near.end(), found->second.begin(), found->second.end());
    }
  }
  std::ranges::sort(near);
  std::vector<const MarkerInMap*> markers;
  for (const std::size_t i : near) markers.push_back(&markers_[i]);
  return markers;
}

std::optional<double> sight_reach_m(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
                                    double highest_m) {
  constexpr double steepest = 5.0;  // per metre of height, 79 degrees from the vertical: no such bound beyond
  constexpr double between_samples = 1.01;  // the border is looked at from pixel to pixel
  double most = 0.0;
  for (const Vec2& pixel : border_of(camera)) {
    const std::optional<Vec2> ray = camera.normalized(pixel);
    if (!ray) return std::nullopt;
    const Vec3 in_base = base_from_camera.linear() * ray->homogeneous();
    if (in_base.z() <= 0.0) return std::nullopt;
    most = std::max(most, in_base.head<2>().norm() / in_base.z());
  }
  if (most > steepest) return std::nullopt;
  const double half_diagonal_m = 1.5 * marker_pitch_m * std::sqrt(2.0);
  const Vec3 mount = base_from_camera.translation();
  const double above_m = std::max(0.0, highest_m + 2.0 * half_diagonal_m - mount.z());
  return between_samples * most * above_m + mount.head<2>().norm() + half_diagonal_m;
}

}  // namespace lodestar
