#include "localization/pose_fix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/map_estimate.hpp"
#include "localization/pose_guess.hpp"

namespace lodestar {
namespace {

/// A detected marker whose place on the ceiling is known.
struct KnownMarker {
  int id = 0;
  double confidence = 0.0;
  std::array<SurveyedDot, 3> direction_dots;  ///< O, X, Y
  std::vector<SurveyedDot> dots;
};

KnownMarker known_marker(const DetectedMarker& seen, const Eigen::Isometry3d& map_from_marker,
                         const PoseFixOptions& options) {
  const auto surveyed = [&](GridCell cell, const Vec2& center_px, double sigma_px = 0.0) {
    const Vec2 in_marker = cell_in_marker(cell);
    return SurveyedDot{map_from_marker * Vec3(in_marker.x(), in_marker.y(), 0.0), center_px,
                       sigma_px > 0.0 ? std::hypot(sigma_px, options.model_sigma_px) : options.dot_sigma_px};
  };
  KnownMarker known{.id = seen.id,
                    .confidence = seen.confidence,
                    .direction_dots = {surveyed(cell_of_o, seen.o_px), surveyed(cell_of_x, seen.x_px),
                                       surveyed(cell_of_y, seen.y_px)},
                    .dots = {}};
  known.dots.reserve(seen.dots.size());
  for (const MarkerDot& dot : seen.dots)
    known.dots.push_back(surveyed(dot.cell, dot.center_px, dot.sigma_px));
  return known;
}

/// Registered markers in the order of the detections. One ID cannot hang in two places: seen twice, it tells
/// nothing.
std::vector<KnownMarker> known_markers(const std::vector<DetectedMarker>& markers,
                                       const MarkerRegistry& registry, const PoseFixOptions& options) {
  std::vector<KnownMarker> known;
  known.reserve(markers.size());
  for (const DetectedMarker& marker : markers) {
    const auto times = std::ranges::count(markers, marker.id, &DetectedMarker::id);
    const RegisteredMarker* registered = registry.find(marker.id);
    if (registered == nullptr || times > 1 || marker.dots.empty()) continue;
    known.push_back(known_marker(marker, map_from_marker(registry, *registered), options));
  }
  return known;
}

std::vector<SurveyedDot> all_dots(std::span<const KnownMarker> markers) {
  std::vector<SurveyedDot> dots;
  dots.reserve(markers.size() * marker_grid_size * marker_grid_size);
  for (const KnownMarker& marker : markers) dots.insert(dots.end(), marker.dots.begin(), marker.dots.end());
  return dots;
}

/// Root mean square distance of dots from where the pose would show them.
double residual_px(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots,
                   const CameraModel& camera) {
  const Eigen::Isometry3d camera_from_map = map_from_camera.inverse();
  double sum = 0.0;
  for (const SurveyedDot& dot : dots) {
    const std::optional<Vec2> seen = camera.project(camera_from_map * dot.point_in_map);
    if (!seen) return std::numeric_limits<double>::infinity();
    sum += (*seen - dot.center_px).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(dots.size()));
}

/// Does every marker lie about where a pose that the prior allows would show it?
bool fits(const MapEstimate& estimate, std::span<const KnownMarker> markers, const CameraModel& camera,
          const PoseFixOptions& options) {
  if (prior_cost(estimate.map_from_camera, options.prior) > options.max_prior_chi2) return false;
  return std::ranges::all_of(markers, [&](const KnownMarker& marker) {
    return residual_px(estimate.map_from_camera, marker.dots, camera) <= options.max_residual_px;
  });
}

/// What P3P makes of the optimal marker, the first, and what it looks like from below; the pose that explains
/// all dots best comes first. A tilt that the prior knows has been tried already.
std::vector<Eigen::Isometry3d> guesses(const KnownMarker& optimal, std::span<const SurveyedDot> dots,
                                       const CameraModel& camera, const PoseFixOptions& options) {
  struct Guess {
    Eigen::Isometry3d map_from_camera;
    double cost = 0.0;
  };
  std::vector<Guess> scored;
  scored.reserve(5);
  const auto add = [&](const Eigen::Isometry3d& guess) {
    scored.push_back({guess, cost_of(guess, dots, camera, options)});
  };
  if (!options.prior.tilt_sigma_rad) {
    if (const auto level = level_guess(optimal.dots, camera, options.prior)) add(*level);
  }
  for (const Eigen::Isometry3d& camera_from_map : p3p_guesses(optimal.direction_dots, camera))
    add(camera_from_map.inverse());
  std::ranges::sort(scored, {}, &Guess::cost);
  std::vector<Eigen::Isometry3d> result;
  for (const Guess& guess : scored) result.push_back(guess.map_from_camera);
  return result;
}

/// Where a mirrored view may explain the dots too, both have their say.
MapEstimate with_mirrored_view(const MapEstimate& estimate, std::span<const SurveyedDot> dots,
                               const CameraModel& camera, const PoseFixOptions& options) {
  if (options.prior.tilt_sigma_rad == 0.0) return estimate;
  const Eigen::Isometry3d other = mirrored(estimate.map_from_camera, dots);
  constexpr double hopeless = 50.0;  // twice the logarithm of the odds
  if (prior_cost(other, options.prior) > estimate.cost + hopeless) return estimate;
  const std::optional<MapEstimate> mirrored_estimate = maximize_posterior(other, dots, camera, options);
  return mirrored_estimate ? likelier(estimate, *mirrored_estimate) : estimate;
}

/// The maximum of the posterior: of the guesses, the first that leads to a pose that fits all markers, or
/// else the best. Where the tilt is known, the pose with that tilt leads there and nothing else need be
/// tried.
std::optional<MapEstimate> best_estimate(std::span<const KnownMarker> markers,
                                         std::span<const SurveyedDot> dots, const CameraModel& camera,
                                         const PoseFixOptions& options) {
  std::optional<MapEstimate> best;
  const auto leads_to_a_fit = [&](const Eigen::Isometry3d& guess) {
    const std::optional<MapEstimate> estimate = maximize_posterior(guess, dots, camera, options);
    if (!estimate || (best && best->cost <= estimate->cost)) return false;
    best = estimate;
    return fits(*best, markers, camera, options);
  };
  const auto level =
      options.prior.tilt_sigma_rad ? level_guess(markers.front().dots, camera, options.prior) : std::nullopt;
  if (!level || !leads_to_a_fit(*level)) {
    for (const Eigen::Isometry3d& guess : guesses(markers.front(), dots, camera, options)) {
      if (leads_to_a_fit(guess)) break;
    }
  }
  if (!best) return std::nullopt;
  return with_mirrored_view(*best, dots, camera, options);
}

/// All markers but the one without which the others agree best.
std::vector<KnownMarker> without_the_odd_one(const std::vector<KnownMarker>& markers,
                                             const CameraModel& camera, const PoseFixOptions& options) {
  std::vector<KnownMarker> best;
  double least_cost = std::numeric_limits<double>::infinity();
  for (std::size_t odd = 0; odd < markers.size(); ++odd) {
    std::vector<KnownMarker> others = markers;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(odd));
    const std::optional<MapEstimate> estimate = best_estimate(others, all_dots(others), camera, options);
    if (!estimate || estimate->cost >= least_cost) continue;
    least_cost = estimate->cost;
    best = std::move(others);
  }
  return best;
}

PoseFix fix_from(Stamp stamp, const MapEstimate& estimate, std::span<const KnownMarker> markers,
                 std::span<const SurveyedDot> dots, const CameraModel& camera) {
  PoseFix fix;
  fix.stamp = stamp;
  fix.map_from_camera = estimate.map_from_camera;
  fix.covariance = estimate.covariance;
  for (const KnownMarker& marker : markers) fix.ids.push_back(marker.id);
  fix.confidence = markers.front().confidence;
  fix.dots = static_cast<int>(dots.size());
  fix.residual_px = residual_px(estimate.map_from_camera, dots, camera);
  return fix;
}

}  // namespace

std::optional<PoseFix> fix_pose(Stamp stamp, const std::vector<DetectedMarker>& markers,
                                const MarkerRegistry& registry, const CameraModel& camera,
                                const PoseFixOptions& options) {
  std::vector<KnownMarker> known = known_markers(markers, registry, options);
  // A marker that hangs elsewhere than surveyed contradicts the others. Three or more can tell which; of two
  // that contradict each other nobody knows, and a robot must not guess.
  while (!known.empty()) {
    const std::vector<SurveyedDot> dots = all_dots(known);
    const std::optional<MapEstimate> estimate = best_estimate(known, dots, camera, options);
    if (estimate && fits(*estimate, known, camera, options))
      return fix_from(stamp, *estimate, known, dots, camera);
    if (known.size() <= 2) return std::nullopt;
    known = without_the_odd_one(known, camera, options);
  }
  return std::nullopt;
}

}  // namespace lodestar
