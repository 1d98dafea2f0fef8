#include "localization/pose/marker_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "localization/pose/map_estimate.hpp"

namespace lodestar {
namespace {

/// Predicted image of a marker: the box around its outermost dots, and its position error.
struct Place {
  Eigen::AlignedBox2d box_px;
  double off_px = 0.0;
};

/// Nothing for a marker that is wholly or partly behind the camera.
std::optional<Place> place_of(const Eigen::Isometry3d& map_from_marker, const ExpectedView& view,
                              const CameraModel& camera, const MarkerTrackerOptions& options) {
  constexpr double reach_m = 1.5 * marker_dot_radius_m;  // beyond the centres of the outermost dots
  constexpr double side_m = (marker_grid_size - 1) * marker_pitch_m;
  const Eigen::Isometry3d camera_from_marker = view.map_from_camera.inverse() * map_from_marker;
  Place place;
  for (const double x : {-reach_m, side_m + reach_m}) {
    for (const double y : {-reach_m, side_m + reach_m}) {
      const std::optional<Vec2> corner = camera.project(camera_from_marker * Vec3(x, y, 0.0));
      if (!corner) return std::nullopt;
      place.box_px.extend(*corner);
    }
  }
  const Vec3 middle = map_from_marker * Vec3(0.5 * side_m, 0.5 * side_m, 0.0);
  const std::optional<Projection> seen = project_dot(view.map_from_camera, middle, camera);
  if (!seen) return std::nullopt;
  const double variance_px2 = (seen->jacobian * view.covariance * seen->jacobian.transpose()).trace();
  place.off_px = options.sigmas * std::sqrt(variance_px2) + options.margin_px;
  return place;
}

Eigen::AlignedBox2d grown(const Eigen::AlignedBox2d& box, double by_px) {
  const Vec2 by(by_px, by_px);
  return {box.min() - by, box.max() + by};
}

cv::Rect pixels_in(const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2i first = box.min().array().floor().cast<int>();
  const Eigen::Vector2i last = box.max().array().ceil().cast<int>();
  return {first.x(), first.y(), last.x() - first.x() + 1, last.y() - first.y() + 1};
}

bool contains(std::span<const DetectedMarker> markers, int id) {
  return std::ranges::find(markers, id, &DetectedMarker::id) != markers.end();
}

}  // namespace

MarkerTracker::MarkerTracker(const MarkerRegistry& registry, const CameraModel& camera,
                             const DetectorOptions& detector, const MarkerTrackerOptions& options)
    : camera_(camera),
      options_(options),
      detector_options_(detector),
      detector_(expecting(registry, detector)) {
  for (const RegisteredMarker& marker : registry.markers)
    markers_in_map_.push_back({marker.id, map_from_marker(registry, marker)});
}

void MarkerTracker::use_registry(const MarkerRegistry& registry) {
  markers_in_map_.clear();
  for (const RegisteredMarker& marker : registry.markers)
    markers_in_map_.push_back({marker.id, map_from_marker(registry, marker)});
  detector_ = MarkerDetector(expecting(registry, detector_options_));
  not_seen_.clear();
}

std::span<const DetectedMarker> MarkerTracker::detect(const cv::Mat& gray,
                                                      const std::optional<ExpectedView>& expected) {
  parts_.clear();
  must_be_seen_.clear();
  if (expected) expect(*expected);
  const bool look_at_all = !expected || parts_.empty() || covers_too_much() ||
                           frames_since_full_search_ + 1 >= options_.full_search_every;
  if (look_at_all) return search_all(gray);
  ++frames_since_full_search_;
  const std::span<const DetectedMarker> found = detector_.detect_within(parts_, gray);
  return found.empty() || lacks_any(found) ? search_all(gray) : found;  // none: it may be anywhere
}

/// Sets the parts of the frame to search, and the markers that must be in them whatever the view's error.
void MarkerTracker::expect(const ExpectedView& view) {
  const Eigen::AlignedBox2d frame(Vec2::Zero(), Vec2(camera_.width_px - 1, camera_.height_px - 1));
  for (const MarkerInMap& marker : markers_in_map_) {
    const std::optional<Place> place = place_of(marker.map_from_marker, view, camera_, options_);
    if (!place) continue;
    const Eigen::AlignedBox2d searched = grown(place->box_px, place->off_px);
    if (!frame.intersects(searched)) continue;
    parts_.push_back(pixels_in(frame.intersection(searched)));
    if (frame.contains(searched)) must_be_seen_.push_back(marker.id);
  }
}

bool MarkerTracker::covers_too_much() const {
  double area_px = 0.0;
  for (const cv::Rect& part : parts_) area_px += static_cast<double>(part.area());
  return area_px > options_.most_of_frame * camera_.width_px * camera_.height_px;
}

bool MarkerTracker::lacks_any(std::span<const DetectedMarker> found) const {
  return std::ranges::any_of(must_be_seen_, [&](int id) {
    return !contains(found, id) && std::ranges::find(not_seen_, id) == not_seen_.end();
  });
}

std::span<const DetectedMarker> MarkerTracker::search_all(const cv::Mat& gray) {
  frames_since_full_search_ = 0;
  const std::span<const DetectedMarker> found = detector_.detect(gray);
  not_seen_.clear();
  for (const int id : must_be_seen_)
    if (!contains(found, id)) not_seen_.push_back(id);
  return found;
}

}  // namespace lodestar
