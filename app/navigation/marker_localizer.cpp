#include "app/navigation/marker_localizer.hpp"

#include <algorithm>

namespace lodestar {
namespace {

/// A robot without a marker in view may drive on to the next one, but with a camera fault only this far. On
/// 0.5 m, unlearned wheel scales (2 % each) turn it by 2 degrees and give 9 mm cross-track error, less than
/// the smallest margin of a path.
constexpr double farthest_with_broken_camera_m = 0.5;

/// Of markers that contradict each other: the fix with the smallest Mahalanobis distance to the estimate, if
/// one passes the gate.
std::optional<FixAttempt> most_expected(const std::vector<FixAttempt>& fixes,
                                        const LocalizationState& known) {
  std::optional<FixAttempt> best;
  double least_distance = 0.0;
  for (const FixAttempt& used : fixes) {
    const std::optional<FixExpectation> expected = known.filter.expectation(used.planar);
    if (!expected || !expected->agrees || (best && expected->squared_distance >= least_distance)) continue;
    best = used;
    least_distance = expected->squared_distance;
  }
  return best;
}

bool is_seen_twice(const DetectedMarker& marker, std::span<const DetectedMarker> markers) {
  return std::ranges::count(markers, marker.id, &DetectedMarker::id) > 1;
}

/// Has the robot driven since a frame agreed with the estimate? A view that changes while the wheels stand is
/// that of a robot which was lifted, or of a ceiling at which people work now: it accuses no marker,
/// unless others in the same frame agree.
bool has_rolled(const LocalizationState& known) {
  constexpr double least_m = 0.01;  // wheels that rolled less have not moved the robot
  return known.integrity.rolled_since_agreement_m() > least_m;
}

bool agrees(const std::optional<FixAttempt>& used, const LocalizationState& known) {
  if (!used) return false;
  const std::optional<FixExpectation> expected = known.filter.expectation(used->planar);
  return expected && expected->agrees;
}

/// Fuses the fix, and passes the outcome on to marker trust and integrity monitor.
void fuse(FixAttempt& used, LocalizationState& known) {
  const std::optional<FixExpectation> expected = known.filter.expectation(used.planar);
  if (expected) used.expected = expected->map_from_base;
  used.outcome = known.filter.add_fix(used.planar);
  if (used.outcome == FixOutcome::accepted) known.trust.add_agreement(used.fix.ids);
  if (used.outcome == FixOutcome::started || used.outcome == FixOutcome::relocated)
    known.trust.estimate_moved();
  known.integrity.add_fix({.stamp = used.fix.stamp,
                           .ids = used.fix.ids,
                           .map_from_base = used.planar.map_from_base,
                           .expected = used.expected,
                           .outcome = used.outcome});
}

StopReason stop_for(CameraFault fault) {
  switch (fault) {
    case CameraFault::silent:
      return StopReason::camera_silent;
    case CameraFault::repeats:
      return StopReason::camera_repeats;
    case CameraFault::dark:
      return StopReason::camera_dark;
    case CameraFault::bright:
      return StopReason::camera_bright;
    case CameraFault::late:
      return StopReason::camera_late;
    case CameraFault::other_clock:
      return StopReason::camera_clock;
  }
  return StopReason::camera_silent;
}

StopReason stop_for(IntegrityAlarm reason) {
  switch (reason) {
    case IntegrityAlarm::contradicted:
      return StopReason::contradicted;
    case IntegrityAlarm::moved:
      return StopReason::pose_moved;
    case IntegrityAlarm::wheels_wrong:
      return StopReason::wheels_wrong;
    case IntegrityAlarm::carried_away:
      return StopReason::carried_away;
    case IntegrityAlarm::wheels_broken:
      return StopReason::wheels_broken;
  }
  return StopReason::contradicted;
}

}  // namespace

void LocalizationState::add_travel(const WheelTravel& reading) {
  filter.add_travel(reading);
  integrity.add_travel(reading);
}

std::optional<StopReason> with_integrity_alarms(const std::optional<StopReason>& reason,
                                                const LocalizationState& known, Stamp now) {
  const std::optional<IntegrityAlarm> alarm = known.integrity.alarm(now);
  if (alarm && (!reason || is_latched(stop_for(*alarm)))) return stop_for(*alarm);
  const std::optional<CameraFault> camera = known.camera.fault(now);
  const bool is_far = known.integrity.rolled_since_agreement_m() > farthest_with_broken_camera_m;
  if (camera && (reason ? can_a_marker_end(*reason) : is_far)) return stop_for(*camera);
  return reason;
}

MarkerLocalizer::MarkerLocalizer(const MarkerRegistry& registry, const CameraModel& camera,
                                 const Eigen::Isometry3d& base_from_camera, const DetectorOptions& detector,
                                 const PoseFixOptions& fix, const PoseFilterOptions& filter,
                                 const VarianceFactor& learned)
    : registry_(registry),
      camera_(camera),
      base_from_camera_(base_from_camera),
      fix_options_(fix),
      tracker_(registry, camera, detector),
      fixer_(registry, camera, learned),
      filter_options_(filter) {
  look_at_ceiling_of(registry);
}

void MarkerLocalizer::look_at_ceiling_of(const MarkerRegistry& registry) {
  const std::optional<double> height_m = ceiling_height_m(registry);
  if (height_m && fix_options_.prior.tilt_sigma_rad)
    ceiling_.emplace(camera_, base_from_camera_, *height_m, *fix_options_.prior.tilt_sigma_rad);
}

/// The ceiling's keyframe stays: its height changes by a survey's millimetres.
void MarkerLocalizer::use_registry(const MarkerRegistry& registry) {
  registry_ = registry;
  tracker_.use_registry(registry);
  fixer_ = PoseFixer(registry, camera_, fixer_.variance_factor());
  if (!ceiling_) look_at_ceiling_of(registry);
}

std::optional<FixAttempt> MarkerLocalizer::see(const Frame& frame, Stamp now, LocalizationState& known) {
  if (known.camera.update(frame, now)) return std::nullopt;
  follow_ceiling(frame, known);
  std::optional<FixAttempt> used = look(frame, known);
  if (known.integrity.take_odometry_failure()) {
    known.filter = PoseFilter(filter_options_);
    known.trust.estimate_moved();
  }
  return used;
}

/// Registers the frame to the keyframe (visual odometry). When too little of the keyframe is in view, or the
/// belief was restarted since and knows no keyframe, this frame becomes the keyframe.
void MarkerLocalizer::follow_ceiling(const Frame& frame, LocalizationState& known) {
  if (!ceiling_) return;
  ceiling_->set_frame(frame);
  const std::optional<MotionExpectation> expected = known.filter.expected_motion(frame.stamp);
  if (expected && expected->from == ceiling_->keyframe_stamp()) {
    const std::optional<VisualOdometryIncrement> motion = ceiling_->motion(expected->then_from_now);
    const bool is_far = ceiling_->leaves_view(expected->then_from_now);
    const bool agrees = motion && known.filter.add_motion(*motion, is_far);
    if (is_far && agrees) ceiling_->set_keyframe();
    if (!is_far || agrees) return;
  }
  if (known.filter.set_keyframe(frame.stamp, ceiling_->sway_m())) ceiling_->set_keyframe();
}

std::optional<FixAttempt> MarkerLocalizer::look(const Frame& frame, LocalizationState& known) {
  const std::span<const DetectedMarker> seen =
      tracker_.detect(frame.gray, view_expected_at(frame.stamp, known));
  std::vector<DetectedMarker> markers(seen.begin(), seen.end());
  std::erase_if(markers, [&](const DetectedMarker& marker) { return !known.trust.trusts(marker.id); });

  std::optional<FixAttempt> used = fix_by(frame, markers);
  if (used) {
    const std::vector<int>& agreeing = used->fix.ids;
    std::erase_if(markers, [&](const DetectedMarker& marker) {
      return agreeing.size() > 1 && std::ranges::find(agreeing, marker.id) != agreeing.end();
    });
  }
  std::vector<FixAttempt> doubted = used && markers.size() == 1 && used->fix.ids.size() == 1
                                        ? std::vector<FixAttempt>{*used}
                                        : fixes_by_each(frame, markers);
  const bool may_accuse = has_rolled(known) || agrees(used ? used : most_expected(doubted, known), known);
  for (const FixAttempt& single : doubted)
    if (may_accuse) judge(single, known);

  if (!used) used = most_expected(doubted, known);
  if (used) {
    fuse(*used, known);
  } else {
    used = contradicted_by_twins(frame, markers, known);
  }
  return used;
}

std::optional<ExpectedView> MarkerLocalizer::view_expected_at(Stamp stamp,
                                                              const LocalizationState& known) const {
  const std::optional<PoseEstimate> robot = known.filter.estimate_at(stamp);
  return robot ? expected_view(*robot, base_from_camera_, fix_options_.prior) : std::nullopt;
}

std::optional<FixAttempt> MarkerLocalizer::fix_by(const Frame& frame,
                                                  std::span<const DetectedMarker> markers) {
  const PoseFix* const fix = fixer_.fix(frame.stamp, markers, fix_options_);
  if (fix == nullptr) return std::nullopt;
  return FixAttempt{.fix = *fix, .planar = compensate_mount(*fix, base_from_camera_)};
}

/// IDs seen twice in the frame are skipped.
std::vector<FixAttempt> MarkerLocalizer::fixes_by_each(const Frame& frame,
                                                       std::span<const DetectedMarker> markers) {
  std::vector<FixAttempt> fixes;
  for (const DetectedMarker& marker : markers) {
    if (is_seen_twice(marker, markers)) continue;
    if (std::optional<FixAttempt> fix = fix_by(frame, std::span(&marker, 1)))
      fixes.push_back(std::move(*fix));
  }
  return fixes;
}

/// An ID seen twice gives no fix. But where neither of the two is where the estimate has it, the robot is
/// elsewhere. Which of them tells where is unknown.
std::optional<FixAttempt> MarkerLocalizer::contradicted_by_twins(const Frame& frame,
                                                                 std::span<const DetectedMarker> markers,
                                                                 LocalizationState& known) {
  std::optional<FixAttempt> contradicting;
  for (const DetectedMarker& marker : markers) {
    if (!is_seen_twice(marker, markers)) continue;
    std::optional<FixAttempt> fix = fix_by(frame, std::span(&marker, 1));
    const std::optional<FixExpectation> expected = fix ? known.filter.expectation(fix->planar) : std::nullopt;
    if (!expected) continue;
    if (expected->agrees) return std::nullopt;
    fix->expected = expected->map_from_base;
    fix->outcome = FixOutcome::refused_gate;
    contradicting = std::move(fix);
  }
  if (contradicting)
    known.integrity.add_fix({.stamp = frame.stamp,
                             .ids = {},
                             .map_from_base = contradicting->planar.map_from_base,
                             .expected = contradicting->expected,
                             .outcome = contradicting->outcome});
  return contradicting;
}

/// Reports the fix of a single marker to marker trust, which counts contradictions to the estimate.
void MarkerLocalizer::judge(const FixAttempt& single, LocalizationState& known) const {
  const int id = single.fix.ids.front();
  const RegisteredMarker* registered = registry_.find(id);
  const std::optional<FixExpectation> expected = known.filter.expectation(single.planar);
  if (registered == nullptr || !expected) return;
  known.trust.add_contradiction(
      {.id = id,
       .marker_in_map = map_from_marker(registry_, *registered).translation().head<2>(),
       .map_from_base_by_marker = single.planar.map_from_base,
       .map_from_base_expected = expected->map_from_base,
       .squared_distance = expected->squared_distance});
}

}  // namespace lodestar
