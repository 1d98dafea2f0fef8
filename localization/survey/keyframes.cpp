#include "localization/survey/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "localization/pose/pose_guess.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {
namespace {

/// The marker as if it hung at the origin of a map, and the level robot's place under it.
std::optional<KeyframeSighting> level_view(const SightedMarker& marker, const CameraModel& camera,
                                           const Eigen::Isometry3d& base_from_camera) {
  const Eigen::Isometry3d map_from_marker = lodestar::map_from_marker({}, RegisteredMarker{.id = marker.id});
  std::vector<SurveyedDot> dots;
  for (const MarkerDot& dot : marker.dots) {
    const Vec2 place = cell_in_marker(dot.cell);
    dots.push_back(
        {.point_in_map = map_from_marker * Vec3(place.x(), place.y(), 0.0), .center_px = dot.center_px});
  }
  const std::optional<Eigen::Isometry3d> guess =
      level_guess(dots, camera, {.tilt = base_from_camera.linear()});
  if (!guess) return std::nullopt;
  const Eigen::Isometry3d marker_from_base = *guess * base_from_camera.inverse();
  return KeyframeSighting{.dots = marker.dots,
                          .base_from_marker = inverse(flattened(marker_from_base)),
                          .above_camera_m = -guess->translation().z()};
}

class Chooser {
 public:
  Chooser(std::span<const SurveyLog> logs, std::span<const KeptStamp> kept, const SurveyOptions& options,
          const SurveyBelief& belief)
      : logs_(logs),
        spacing_time_(options.spacing_time),
        spacing_m_(options.spacing_m),
        spacing_rad_(options.spacing_rad),
        gauge_{.difference = 0.0, .track_m = belief.track_width_m} {
    for (const KeptStamp& stamp : kept)
      kept_.insert({stamp.log, nearest_frame(logs[stamp.log], stamp.stamp)});
  }

  /// Indices of the frames of each log, no more than `most` in all but for a few.
  [[nodiscard]] std::vector<std::vector<std::size_t>> of_all(std::size_t most) {
    constexpr double farthest = 3.0;  // an aisle's markers must still be seen from several
    const double most_m = farthest * spacing_m_;
    while (true) {
      std::vector<std::vector<std::size_t>> chosen;
      std::size_t count = 0;
      for (std::size_t log = 0; log < logs_.size(); ++log) count += chosen.emplace_back(of_log(log)).size();
      if (count <= most || spacing_m_ >= most_m) return chosen;
      spacing_m_ =
          std::min(most_m, spacing_m_ * 1.1 * static_cast<double>(count) / static_cast<double>(most));
    }
  }

 private:
  /// Indices of the frames of a log.
  [[nodiscard]] std::vector<std::size_t> of_log(std::size_t log) const {
    std::vector<std::size_t> chosen;
    const std::vector<SurveyFrame>& frames = logs_[log].frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (frames[i].markers.empty()) continue;
      if (kept_.contains({log, i}) || chosen.empty() || is_far(log, frames[chosen.back()], frames[i]))
        chosen.push_back(i);
    }
    return chosen;
  }

  static std::size_t nearest_frame(const SurveyLog& log, Stamp stamp) {
    std::size_t nearest = 0;
    Duration least = Duration::max();
    for (std::size_t i = 0; i < log.frames.size(); ++i) {
      if (log.frames[i].markers.empty()) continue;
      const Duration off = std::chrono::abs(log.frames[i].stamp - stamp);
      if (off < least) {
        least = off;
        nearest = i;
      }
    }
    return nearest;
  }

  [[nodiscard]] bool is_far(std::size_t log, const SurveyFrame& last, const SurveyFrame& frame) const {
    const auto rolled = WheelSegment::between(logs_[log].wheels, last.stamp, frame.stamp);
    if (!rolled) return frame.stamp - last.stamp >= spacing_time_;
    const WheelMotion motion = rolled->motion(gauge_);
    return rolled->rolled_m() >= spacing_m_ || std::abs(motion.turn_rad) >= spacing_rad_;
  }

  std::span<const SurveyLog> logs_;
  Duration spacing_time_;
  double spacing_m_;
  double spacing_rad_;
  WheelGauge gauge_;
  std::set<std::pair<std::size_t, std::size_t>> kept_;
};

/// No frame beside this one shows the marker, though one is near enough to.
bool is_seen_once(const SurveyLog& log, std::size_t at, int id) {
  // Images may be kept once or twice a second; a marker stays in view for longer.
  constexpr Duration near = std::chrono::milliseconds(1000);
  bool is_looked_for = false;
  for (const std::size_t beside : {at - 1, at + 1}) {
    if (beside >= log.frames.size()) continue;  // at - 1 of the first wraps
    const SurveyFrame& frame = log.frames[beside];
    if (std::chrono::abs(frame.stamp - log.frames[at].stamp) > near) continue;
    if (std::ranges::find(frame.markers, id, &SightedMarker::id) != frame.markers.end()) return false;
    is_looked_for = true;
  }
  return is_looked_for;
}

/// IDs that are seen longer somewhere: elsewhere one frame alone of theirs is a misreading.
std::set<int> ids_seen_longer(std::span<const SurveyLog> logs) {
  std::set<int> ids;
  for (const SurveyLog& log : logs)
    for (std::size_t i = 0; i < log.frames.size(); ++i)
      for (const SightedMarker& marker : log.frames[i].markers)
        if (!ids.contains(marker.id) && !is_seen_once(log, i, marker.id)) ids.insert(marker.id);
  return ids;
}

void number_markers(SurveyKeyframes& keyframes) {
  std::set<int> ids;
  for (const int id : keyframes.ids) ids.insert(id);
  std::vector<int> sorted(ids.begin(), ids.end());
  std::size_t at = 0;
  for (SurveyKeyframe& frame : keyframes.frames) {
    for (KeyframeSighting& sighting : frame.sightings) {
      const auto found = std::ranges::lower_bound(sorted, keyframes.ids[at++]);
      sighting.marker = static_cast<std::size_t>(found - sorted.begin());
    }
  }
  keyframes.ids = std::move(sorted);
}

}  // namespace

SurveyKeyframes choose_keyframes(std::span<const SurveyLog> logs, std::span<const KeptStamp> kept,
                                 const CameraModel& camera, const SurveyBelief& belief,
                                 const SurveyOptions& options) {
  SurveyKeyframes result;
  const std::set<int> seen_longer = ids_seen_longer(logs);
  const std::vector<std::vector<std::size_t>> chosen =
      Chooser(logs, kept, options, belief).of_all(options.most_keyframes);
  for (std::size_t log = 0; log < logs.size(); ++log) {
    const CeilingTrack ceiling(logs[log].ceiling);
    bool first = true;
    for (const std::size_t i : chosen[log]) {
      const SurveyFrame& frame = logs[log].frames[i];
      SurveyKeyframe keyframe{.log = log, .stamp = frame.stamp};
      std::vector<int> ids;
      for (const SightedMarker& marker : frame.markers) {
        if (static_cast<int>(marker.dots.size()) < options.least_dots) continue;
        if (seen_longer.contains(marker.id) && is_seen_once(logs[log], i, marker.id)) continue;
        if (auto view = level_view(marker, camera, belief.base_from_camera)) {
          keyframe.sightings.push_back(std::move(*view));
          ids.push_back(marker.id);
        }
      }
      if (keyframe.sightings.empty()) continue;
      if (!first) {
        const Stamp previous = result.frames.back().stamp;
        keyframe.from_previous = WheelSegment::between(logs[log].wheels, previous, keyframe.stamp);
        keyframe.by_ceiling = ceiling.between(previous, keyframe.stamp);
      }
      first = false;
      result.ids.insert(result.ids.end(), ids.begin(), ids.end());
      result.frames.push_back(std::move(keyframe));
    }
  }
  number_markers(result);
  return result;
}

}  // namespace lodestar
