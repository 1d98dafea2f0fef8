#include "localization/pose_fix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/map_estimate.hpp"
#include "localization/p3p.hpp"

namespace lodestar {
namespace {

/// A detected marker together with its place on the ceiling.
struct KnownMarker {
  const DetectedMarker* seen = nullptr;
  Eigen::Isometry3d map_from_marker = Eigen::Isometry3d::Identity();
};

Vec3 in_map(const KnownMarker& marker, GridCell cell) {
  const Vec2 in_marker = cell_in_marker(cell);
  return marker.map_from_marker * Vec3(in_marker.x(), in_marker.y(), 0.0);
}

/// Registered markers in the order of the detections. One ID cannot hang in two places: seen twice, it tells
/// nothing.
std::vector<KnownMarker> known_markers(const std::vector<DetectedMarker>& markers,
                                       const MarkerRegistry& registry) {
  std::vector<KnownMarker> known;
  for (const DetectedMarker& marker : markers) {
    const auto times = std::ranges::count(markers, marker.id, &DetectedMarker::id);
    const RegisteredMarker* registered = registry.find(marker.id);
    if (registered == nullptr || times > 1) continue;
    known.push_back({&marker, map_from_marker(registry, *registered)});
  }
  return known;
}

std::vector<SurveyedDot> surveyed_dots(const std::vector<KnownMarker>& markers) {
  std::vector<SurveyedDot> dots;
  for (const KnownMarker& marker : markers) {
    for (const MarkerDot& dot : marker.seen->dots) dots.push_back({in_map(marker, dot.cell), dot.center_px});
  }
  return dots;
}

/// Eq. (12) and (13).
std::optional<Vec3> ray_through(const Vec2& pixel, const CameraModel& camera) {
  const std::optional<Vec2> normalized = camera.normalized(pixel);
  if (!normalized) return std::nullopt;
  return Vec3(normalized->x(), normalized->y(), 1.0).normalized();
}

/// P3P on one marker's O, X and Y.
std::vector<Eigen::Isometry3d> p3p_guesses(const KnownMarker& marker, const CameraModel& camera) {
  const auto o = ray_through(marker.seen->o_px, camera);
  const auto x = ray_through(marker.seen->x_px, camera);
  const auto y = ray_through(marker.seen->y_px, camera);
  std::vector<Eigen::Isometry3d> guesses;
  if (!o || !x || !y) return guesses;
  const std::array<Vec3, 3> points{in_map(marker, cell_of_o), in_map(marker, cell_of_x),
                                   in_map(marker, cell_of_y)};
  for (const Eigen::Isometry3d& camera_from_map : solve_p3p({*o, *x, *y}, points)) {
    guesses.push_back(camera_from_map.inverse());
  }
  return guesses;
}

/// With the tilt as the prior has it, the ceiling's points and their rays, brought to unit height, are
/// similar figures: turned by the heading, scaled by the distance. Least squares over one marker's dots, in
/// closed form.
std::optional<Eigen::Isometry3d> level_guess(const KnownMarker& marker, const CameraModel& camera,
                                             const PosePrior& prior) {
  Vec2 mean_ray = Vec2::Zero();
  Vec3 mean_point = Vec3::Zero();
  std::vector<std::pair<Vec2, Vec3>> matches;
  for (const MarkerDot& dot : marker.seen->dots) {
    const std::optional<Vec3> ray = ray_through(dot.center_px, camera);
    if (!ray) return std::nullopt;
    const Vec3 level = prior.tilt * *ray;
    if (!(level.z() > 0.0)) return std::nullopt;
    matches.emplace_back(level.head<2>() / level.z(), in_map(marker, dot.cell));
    mean_ray += matches.back().first;
    mean_point += matches.back().second;
  }
  mean_ray /= static_cast<double>(matches.size());
  mean_point /= static_cast<double>(matches.size());
  double along = 0.0;
  double across = 0.0;
  double spread = 0.0;
  for (const auto& [ray, point] : matches) {
    const Vec2 r = ray - mean_ray;
    const Vec2 p = point.head<2>() - mean_point.head<2>();
    along += r.dot(p);
    across += r.x() * p.y() - r.y() * p.x();
    spread += r.squaredNorm();
  }
  const double distance_m = std::hypot(along, across) / spread;
  if (!std::isfinite(distance_m) || distance_m <= 0.0) return std::nullopt;
  const Eigen::Matrix3d heading =
      Eigen::AngleAxisd(std::atan2(across, along), Vec3::UnitZ()).toRotationMatrix();
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
  guess.linear() = heading * prior.tilt;
  guess.translation() = mean_point - heading * Vec3(mean_ray.x(), mean_ray.y(), 1.0) * distance_m;
  return guess;
}

/// Of all starting points the estimate that ends with the least cost over all dots.
std::optional<MapEstimate> best_estimate(const std::vector<KnownMarker>& markers,
                                         const std::vector<SurveyedDot>& dots, const CameraModel& camera,
                                         const PoseFixOptions& options) {
  std::vector<Eigen::Isometry3d> guesses = p3p_guesses(markers.front(), camera);
  if (const auto level = level_guess(markers.front(), camera, options.prior)) guesses.push_back(*level);
  std::optional<MapEstimate> best;
  for (const Eigen::Isometry3d& guess : guesses) {
    const std::optional<MapEstimate> estimate = maximize_posterior(guess, dots, camera, options);
    if (estimate && (!best || estimate->cost < best->cost)) best = estimate;
  }
  return best;
}

/// Root mean square distance of dots from where the pose would show them.
double residual_px(const Eigen::Isometry3d& map_from_camera, const std::vector<SurveyedDot>& dots,
                   const CameraModel& camera) {
  double sum = 0.0;
  for (const SurveyedDot& dot : dots) {
    const std::optional<Projection> seen = project_dot(map_from_camera, dot.point_in_map, camera);
    if (!seen) return std::numeric_limits<double>::infinity();
    sum += (seen->pixel - dot.center_px).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(dots.size()));
}

/// Does every marker's every dot lie about where the pose would show it?
bool fits(const MapEstimate& estimate, const std::vector<KnownMarker>& markers, const CameraModel& camera,
          double max_residual_px) {
  return std::ranges::all_of(markers, [&](const KnownMarker& marker) {
    return residual_px(estimate.map_from_camera, surveyed_dots({marker}), camera) <= max_residual_px;
  });
}

/// All markers but the one without which the others agree best.
std::vector<KnownMarker> without_the_odd_one(const std::vector<KnownMarker>& markers,
                                             const CameraModel& camera, const PoseFixOptions& options) {
  std::vector<KnownMarker> best;
  double least_cost = std::numeric_limits<double>::infinity();
  for (std::size_t odd = 0; odd < markers.size(); ++odd) {
    std::vector<KnownMarker> others = markers;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(odd));
    const std::optional<MapEstimate> estimate = best_estimate(others, surveyed_dots(others), camera, options);
    if (!estimate || estimate->cost >= least_cost) continue;
    least_cost = estimate->cost;
    best = std::move(others);
  }
  return best;
}

PoseFix fix_from(Stamp stamp, const MapEstimate& estimate, const std::vector<KnownMarker>& markers,
                 const std::vector<SurveyedDot>& dots, const CameraModel& camera) {
  PoseFix fix;
  fix.stamp = stamp;
  fix.map_from_camera = estimate.map_from_camera;
  fix.covariance = estimate.covariance;
  for (const KnownMarker& marker : markers) fix.ids.push_back(marker.seen->id);
  fix.confidence = markers.front().seen->confidence;
  fix.dots = static_cast<int>(dots.size());
  fix.residual_px = residual_px(estimate.map_from_camera, dots, camera);
  return fix;
}

}  // namespace

std::optional<PoseFix> fix_pose(Stamp stamp, const std::vector<DetectedMarker>& markers,
                                const MarkerRegistry& registry, const CameraModel& camera,
                                const PoseFixOptions& options) {
  std::vector<KnownMarker> known = known_markers(markers, registry);
  // A marker that hangs elsewhere than surveyed contradicts the others. Three or more can tell which; of two
  // that contradict each other nobody knows, and a robot must not guess.
  while (!known.empty()) {
    const std::vector<SurveyedDot> dots = surveyed_dots(known);
    const std::optional<MapEstimate> estimate = best_estimate(known, dots, camera, options);
    if (!estimate) return std::nullopt;
    if (fits(*estimate, known, camera, options.max_residual_px))
      return fix_from(stamp, *estimate, known, dots, camera);
    if (known.size() <= 2) return std::nullopt;
    known = without_the_odd_one(known, camera, options);
  }
  return std::nullopt;
}

}  // namespace lodestar
