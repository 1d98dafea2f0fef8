#include "localization/pose/pose_fixer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "localization/pose/pose_guess.hpp"

namespace lodestar {
namespace {

/// For small numbers, without the overflow protection of std::hypot.
double root_of_squares(double a, double b) {
  return std::sqrt(a * a + b * b);
}

/// Image scale of the marker's plane, from the edges OX and OY.
double px_per_m(const DetectedMarker& seen) {
  constexpr double edges_m = 2 * (marker_grid_size - 1) * marker_pitch_m;
  return ((seen.x_px - seen.o_px).norm() + (seen.y_px - seen.o_px).norm()) / edges_m;
}

/// What the registry leaves open, and the ceiling.
std::optional<MarkerSigma> doubt(std::optional<MarkerSigma> registered, const PoseFixOptions& options) {
  MarkerSigma sigma = registered.value_or(options.unstated_sigma);
  if (options.marker_tilt_sigma_rad > 0.0) sigma.tilt_rad = options.marker_tilt_sigma_rad;
  const bool is_exact = sigma.position_m == 0.0 && sigma.yaw_rad == 0.0 && sigma.tilt_rad == 0.0;
  return is_exact ? std::nullopt : std::optional(sigma);
}

KnownMarker known_marker(const DetectedMarker& seen, const Eigen::Isometry3d& map_from_marker,
                         const std::optional<MarkerSigma>& sigma, const PoseFixOptions& options,
                         double variance_factor) {
  const double sigma_factor = std::sqrt(variance_factor);
  const double place_px = options.dot_place_sigma_m * px_per_m(seen);
  const auto surveyed = [&](GridCell cell, const Vec2& center_px, double sigma_px = 0.0) {
    const Vec2 in_marker = cell_in_marker(cell);
    const double own_px = sigma_factor * (sigma_px > 0.0 ? sigma_px : options.dot_sigma_px);
    return SurveyedDot{map_from_marker * Vec3(in_marker.x(), in_marker.y(), 0.0), center_px,
                       place_px > 0.0 ? root_of_squares(own_px, place_px) : own_px, place_px};
  };
  KnownMarker known{.id = seen.id,
                    .confidence = seen.confidence,
                    .direction_dots = {surveyed(cell_of_o, seen.o_px), surveyed(cell_of_x, seen.x_px),
                                       surveyed(cell_of_y, seen.y_px)},
                    .sigma = sigma,
                    .dots = {}};
  for (const MarkerDot& dot : seen.dots)
    known.dots.push_back(surveyed(dot.cell, dot.center_px, dot.sigma_px));
  return known;
}

Vec2 origin_m(const KnownMarker& marker) {
  return marker.direction_dots[0].point_in_map.head<2>();
}

/// Sum of the squared reprojection errors, with the marker where it most likely is; infinite where its
/// registered place does not allow that. Infinite behind the camera.
double squared_px(const Eigen::Isometry3d& map_from_camera, const KnownMarker& marker,
                  const CameraModel& camera, const PoseFixOptions& options) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (marker.sigma) {
    const auto dots = eliminate_offset(map_from_camera, marker.dots, origin_m(marker), *marker.sigma, camera,
                                       options.robust_scale);
    return dots && dots->chi2_of_offset <= options.max_offset_chi2 ? dots->squared_px : none;
  }
  const Eigen::Isometry3d camera_from_map = map_from_camera.inverse();
  double sum = 0.0;
  for (const SurveyedDot& dot : marker.dots) {
    const std::optional<Vec2> seen = camera.project(camera_from_map * dot.point_in_map);
    if (!seen) return none;
    sum += (*seen - dot.center_px).squaredNorm();
  }
  return sum;
}

/// Root mean square.
double residual_px(double squared_px, std::size_t dots) {
  return std::sqrt(squared_px / static_cast<double>(dots));
}

/// True when the prior allows the pose and the reprojection error of each marker is small enough.
bool fits(const MapEstimate& estimate, std::span<const KnownMarker> markers, const CameraModel& camera,
          const PoseFixOptions& options) {
  if (prior_cost(estimate.map_from_camera, options.prior) > options.max_prior_chi2) return false;
  return std::ranges::all_of(markers, [&](const KnownMarker& marker) {
    const double squared = squared_px(estimate.map_from_camera, marker, camera, options);
    return residual_px(squared, marker.dots.size()) <= options.max_residual_px;
  });
}

struct Guess {
  Eigen::Isometry3d map_from_camera;
  double cost = 0.0;
};
using Guesses = InlineVector<Guess, 5>;

/// P3P solutions for the optimal marker (the first), and its level guess when the prior's tilt is unknown;
/// the lowest cost over all dots comes first. A known tilt has been tried already.
Guesses guesses(const KnownMarker& optimal, std::span<const SurveyedDot> dots, const CameraModel& camera,
                const PoseFixOptions& options) {
  Guesses scored;
  const auto add = [&](const Eigen::Isometry3d& guess) {
    scored.push_back({guess, cost_of(guess, dots, camera, options)});
    for (std::size_t i = scored.size() - 1; i > 0 && scored[i].cost < scored[i - 1].cost; --i)
      std::swap(scored[i], scored[i - 1]);
  };
  if (!options.prior.tilt_sigma_rad) {
    if (const auto level = level_guess(optimal.dots, camera, options.prior)) add(*level);
  }
  for (const Eigen::Isometry3d& camera_from_map : p3p_guesses(optimal.direction_dots, camera))
    add(camera_from_map.inverse());
  return scored;
}

/// Merges both modes of the planar ambiguity.
MapEstimate with_mirrored_view(const MapEstimate& estimate, std::span<const SurveyedDot> dots,
                               std::span<const DotsOfMarker> markers, const CameraModel& camera,
                               const PoseFixOptions& options) {
  if (options.prior.tilt_sigma_rad == 0.0) return estimate;
  const Eigen::Isometry3d other = mirrored(estimate.map_from_camera, dots);
  constexpr double hopeless = 50.0;  // twice the log odds
  if (prior_cost(other, options.prior) > estimate.cost + hopeless) return estimate;
  const std::optional<MapEstimate> mirrored_estimate =
      maximize_posterior(other, dots, camera, options, markers);
  return mirrored_estimate ? likelier(estimate, *mirrored_estimate) : estimate;
}

}  // namespace

PoseFixer::PoseFixer(const MarkerRegistry& registry, const CameraModel& camera, const VarianceFactor& learned)
    : camera_(camera), variance_factor_(learned) {
  for (const RegisteredMarker& marker : registry.markers) {
    if (registry.find(marker.id) != nullptr)
      markers_in_map_.push_back({marker.id, map_from_marker(registry, marker), marker.sigma, std::nullopt});
  }
  std::ranges::sort(markers_in_map_, {}, &MarkerInMap::id);
}

const PoseFix* PoseFixer::fix(Stamp stamp, std::span<const DetectedMarker> markers,
                              const PoseFixOptions& options) {
  find_known(markers, options);
  // A displaced marker contradicts the others. Among three or more it can be identified; between two it
  // cannot, and the fix is refused.
  while (!known_.empty()) {
    const std::optional<MapEstimate> estimate = best_estimate(known_, options);
    if (estimate && fits(*estimate, known_, camera_, options)) {
      learn(*estimate);
      conclude(stamp, *estimate, options);
      return &fix_;
    }
    if (known_.size() <= 2) return nullptr;
    reject_outlier_marker(options);
  }
  return nullptr;
}

const PoseFixer::MarkerInMap* PoseFixer::marker_in_map(int id) const {
  const auto place = std::ranges::lower_bound(markers_in_map_, id, {}, &MarkerInMap::id);
  return place != markers_in_map_.end() && place->id == id ? &*place : nullptr;
}

/// Registered markers in the order of the detections. An ID that is seen twice is ambiguous and ignored.
void PoseFixer::find_known(std::span<const DetectedMarker> markers, const PoseFixOptions& options) {
  known_.clear();
  for (const DetectedMarker& marker : markers) {
    const auto times = std::ranges::count(markers, marker.id, &DetectedMarker::id);
    const MarkerInMap* const registered = marker_in_map(marker.id);
    if (registered == nullptr || times > 1 || marker.dots.empty()) continue;
    known_.push_back(known_marker(marker, registered->map_from_marker, doubt(registered->sigma, options),
                                  options, variance_factor_.value()));
  }
}

void PoseFixer::collect_dots(std::span<const KnownMarker> markers) {
  dots_.clear();
  in_doubt_.clear();
  for (const KnownMarker& marker : markers) dots_.insert(dots_.end(), marker.dots.begin(), marker.dots.end());
  if (std::ranges::none_of(markers, [](const KnownMarker& marker) { return marker.sigma.has_value(); }))
    return;
  for (const KnownMarker& marker : markers)
    in_doubt_.push_back({marker.dots.size(), origin_m(marker), marker.sigma});
}

/// Maximum of the posterior: from the first guess that leads to a pose that fits all markers, or else the
/// best one. With a known tilt, the guess with that tilt leads there and no other needs to be tried.
std::optional<MapEstimate> PoseFixer::best_estimate(std::span<const KnownMarker> markers,
                                                    const PoseFixOptions& options) {
  collect_dots(markers);
  std::optional<MapEstimate> best;
  const auto leads_to_a_fit = [&](const Eigen::Isometry3d& guess) {
    const std::optional<MapEstimate> estimate = maximize_posterior(guess, dots_, camera_, options, in_doubt_);
    if (!estimate || (best && best->cost <= estimate->cost)) return false;
    best = estimate;
    return fits(*best, markers, camera_, options);
  };
  const auto level = options.prior.tilt_sigma_rad ? level_guess_by(markers, options.prior) : std::nullopt;
  if (!level || !leads_to_a_fit(*level)) {
    for (const Guess& guess : guesses(markers.front(), dots_, camera_, options)) {
      if (leads_to_a_fit(guess.map_from_camera)) break;
    }
  }
  if (!best) return std::nullopt;
  return with_mirrored_view(*best, dots_, in_doubt_, camera_, options);
}

/// From O, X and Y of all markers at the first one's height; from all dots of a single marker.
std::optional<Eigen::Isometry3d> PoseFixer::level_guess_by(std::span<const KnownMarker> markers,
                                                           const PosePrior& prior) {
  constexpr double same_height_m = 0.001;
  const auto height_m = [](const KnownMarker& marker) { return marker.direction_dots[0].point_in_map.z(); };
  if (markers.size() == 1) return level_guess(markers.front().dots, camera_, prior);
  guess_dots_.clear();
  for (const KnownMarker& marker : markers) {
    if (std::abs(height_m(marker) - height_m(markers.front())) > same_height_m) continue;
    guess_dots_.insert(guess_dots_.end(), marker.direction_dots.begin(), marker.direction_dots.end());
  }
  return level_guess(guess_dots_, camera_, prior);
}

/// Removes the marker without which the others agree best; removes all when none agree.
void PoseFixer::reject_outlier_marker(const PoseFixOptions& options) {
  best_others_.clear();
  double least_cost = std::numeric_limits<double>::infinity();
  for (std::size_t odd = 0; odd < known_.size(); ++odd) {
    others_.clear();
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (i != odd) others_.push_back(known_[i]);
    const std::optional<MapEstimate> estimate = best_estimate(others_, options);
    if (!estimate || estimate->cost >= least_cost) continue;
    least_cost = estimate->cost;
    std::swap(best_others_, others_);
  }
  std::swap(known_, best_others_);
}

/// While the camera stands still, frames differ only by noise and add no information.
void PoseFixer::learn(const MapEstimate& estimate) {
  if (!has_moved()) return;
  for (const KnownMarker& marker : known_) place_learned_at(marker.id) = marker.direction_dots[0].center_px;
  variance_factor_.add(estimate.chi2, estimate.freedom);
}

/// Has the image moved since each of these markers was last learned from? A displaced marker is evaluated in
/// turn with the others, so each is compared with itself.
bool PoseFixer::has_moved() {
  constexpr double moved_px = 0.5;
  bool is_new = true;
  for (const KnownMarker& marker : known_) {
    const std::optional<Vec2>& before_px = place_learned_at(marker.id);
    if (!before_px) continue;
    if ((marker.direction_dots[0].center_px - *before_px).squaredNorm() >= moved_px * moved_px) return true;
    is_new = false;
  }
  return is_new;
}

std::optional<Vec2>& PoseFixer::place_learned_at(int id) {
  return std::ranges::lower_bound(markers_in_map_, id, {}, &MarkerInMap::id)->learned_at_px;
}

void PoseFixer::conclude(Stamp stamp, const MapEstimate& estimate, const PoseFixOptions& options) {
  fix_.stamp = stamp;
  fix_.map_from_camera = estimate.map_from_camera;
  fix_.covariance = estimate.covariance;
  fix_.shared_covariance = estimate.shared_covariance;
  fix_.by_offsets.clear();
  for (std::size_t i = 0; i < estimate.by_offsets.size(); ++i)
    if (known_[i].sigma) fix_.by_offsets.push_back({known_[i].id, estimate.by_offsets[i]});
  fix_.ids.clear();
  double squared = 0.0;
  for (const KnownMarker& marker : known_) {
    fix_.ids.push_back(marker.id);
    squared += squared_px(estimate.map_from_camera, marker, camera_, options);
  }
  fix_.confidence = known_.front().confidence;
  fix_.dots = static_cast<int>(dots_.size());
  fix_.residual_px = residual_px(squared, dots_.size());
}

std::optional<PoseFix> fix_pose(Stamp stamp, std::span<const DetectedMarker> markers,
                                const MarkerRegistry& registry, const CameraModel& camera,
                                const PoseFixOptions& options) {
  PoseFixer fixer(registry, camera);
  const PoseFix* const fix = fixer.fix(stamp, markers, options);
  return fix != nullptr ? std::optional(*fix) : std::nullopt;
}

}  // namespace lodestar
