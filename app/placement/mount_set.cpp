#include "app/placement/mount_set.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "localization/pose/pose_fix.hpp"
#include "localization/survey/wheel_segment.hpp"

namespace lodestar {
namespace {

/// The dots of the markers used in the fix.
std::vector<SurveyedDot> dots_of_fix(const PoseFix& fix, std::span<const DetectedMarker> markers,
                                     const MarkerRegistry& registry) {
  std::vector<SurveyedDot> dots;
  for (const DetectedMarker& marker : markers) {
    if (std::ranges::find(fix.ids, marker.id) == fix.ids.end()) continue;
    const Eigen::Isometry3d map_from_seen = map_from_marker(registry, *registry.find(marker.id));
    for (const MarkerDot& dot : marker.dots) {
      const Vec2 in_marker = cell_in_marker(dot.cell);
      dots.push_back({map_from_seen * Vec3(in_marker.x(), in_marker.y(), 0.0), dot.center_px});
    }
  }
  return dots;
}

/// The mount is what is estimated, so the initial fix has only a weak prior on it.
PoseFixOptions loose_options(const Robot& robot) {
  constexpr double loose_deg = 3.0;
  PoseFixOptions options;
  options.prior.tilt = rotation_from({robot.camera_mount.roll_rad, robot.camera_mount.pitch_rad, 0.0});
  options.prior.tilt_sigma_rad = radians(loose_deg);
  return options;
}

/// Frames whose travel is not logged at their exposure are left out.
void shift_travel(MountSet& set, std::vector<HeadingSample>& headings, std::span<const WheelTravel> wheels) {
  const Duration late = from_seconds(set.time_offset->late_s);
  std::vector<MountFrame> shifted;
  for (std::size_t i = 0; i < set.frames.size(); ++i) {
    const std::optional<Vec2> travel_m = travel_at(wheels, headings[i].stamp - late);
    if (!travel_m) continue;
    shifted.push_back(std::move(set.frames[i]));
    shifted.back().left_m = travel_m->x();
    shifted.back().right_m = travel_m->y();
  }
  set.frames = std::move(shifted);
}

std::string in_words(const TimeOffset& offset) {
  constexpr double ms_per_s = 1e3;
  std::string words = fmt::format("{:.1f} ms {}  +- {:.2g}", ms_per_s * std::abs(offset.late_s),
                                  offset.late_s < 0.0 ? "early" : "late", ms_per_s * offset.sigma_s);
  if (offset.is_significant() && offset.late_s > 0.0) words += ": add it to latency_ms in site.yaml";
  return words;
}

struct Part {
  const char* key;
  double value;
  double sigma;
  bool measured;
  int decimals;
};

std::vector<Part> parts_of(const MountEstimate& mount) {
  const RollPitchYaw& angles = mount.angles;
  const RollPitchYaw& sigmas = mount.angle_sigmas;
  const Vec3& at = mount.position_m;
  const Vec3& off = mount.position_sigmas_m;
  return {{"x_m", at.x(), off.x(), true, 5},
          {"y_m", at.y(), off.y(), true, 5},
          {"z_m", at.z(), off.z(), mount.measured_height, 5},
          {"roll_deg", degrees(angles.roll_rad), degrees(sigmas.roll_rad), mount.measured_tilt, 4},
          {"pitch_deg", degrees(angles.pitch_rad), degrees(sigmas.pitch_rad), mount.measured_tilt, 4},
          {"yaw_deg", degrees(angles.yaw_rad), degrees(sigmas.yaw_rad), mount.measured_yaw, 4}};
}

std::string complaint(MountFlaw flaw, const MountSet& set, const MountCalibration& calibration,
                      const MountCalibrationOptions& options) {
  switch (flaw) {
    case MountFlaw::too_few_fixes:
      return fmt::format(
          "found {} places with registered markers in view ({} of {} images), wanted at least {}",
          calibration.frames, set.frames.size(), set.images, options.least_frames);
    case MountFlaw::too_few_turns:
      return fmt::format("found {:.1f} turns on the spot in one go, wanted at least {:.0f}, better five",
                         calibration.turns, options.least_turns);
    case MountFlaw::offset_undetermined:
      return fmt::format(
          "found an offset that stays uncertain by more than {:.1f} mm: more turns, more markers "
          "in view",
          1000.0 * options.most_offset_sigma_m);
    case MountFlaw::contradiction:
      return "found dots, registry and wheels that do not fit together: look at the camera file, the survey, "
             "left and right in wheels.csv, its clock, and the robot's track width";
  }
  return "";
}

}  // namespace

MountSet mount_set_of(const SurveyLog& log, const MarkerRegistry& registry, const CameraModel& camera,
                      const Robot& robot) {
  const PoseFixOptions options = loose_options(robot);
  MountSet set{.images = log.frames.size()};
  std::vector<HeadingSample> headings;  // of the frames
  for (const SurveyFrame& frame : log.frames) {
    const std::optional<Vec2> travel_m = travel_at(log.wheels, frame.stamp);
    if (!travel_m) continue;
    const std::vector<DetectedMarker> markers = whole_markers(frame);
    const std::optional<PoseFix> fix = fix_pose(frame.stamp, markers, registry, camera, options);
    if (!fix) continue;
    set.frames.push_back({.dots = dots_of_fix(*fix, markers, registry),
                          .map_from_camera = fix->map_from_camera,
                          .left_m = travel_m->x(),
                          .right_m = travel_m->y()});
    headings.push_back({frame.stamp, flattened(fix->map_from_camera).yaw_rad});
  }
  set.time_offset = estimate_time_offset(headings, log.wheels, robot.track_width_m);
  if (set.time_offset && set.time_offset->is_significant()) shift_travel(set, headings, log.wheels);
  return set;
}

MountBelief belief_of(const Robot& robot) {
  return {.angles = robot.camera_mount,
          .position_m = robot.base_from_camera.translation(),
          .track_width_m = robot.track_width_m,
          .wobble_sigma_rad = robot.mount_tilt_sigma_rad};
}

std::string text_report(const MountSet& set, const MountCalibration& calibration) {
  std::string text = fmt::format("markers in view in {} of {} images, {} places used\n", set.frames.size(),
                                 set.images, calibration.frames);
  text +=
      fmt::format("{:.1f} turns on the spot, {:.2f} m straight\n", calibration.turns, calibration.straight_m);
  text += fmt::format("images are stamped {}\n",
                      set.time_offset ? in_words(*set.time_offset) : "at a time not observable in this log");
  if (calibration.circle)
    text += fmt::format("the camera's circle: radius {:.4f} m\n", calibration.circle->radius_m);
  if (!calibration.estimate) return text;
  const MountEstimate& mount = *calibration.estimate;
  for (const Part& part : parts_of(mount)) {
    text += part.measured
                ? fmt::format("{:<9} {:>9.{}f}  +- {:.2g}\n", part.key, part.value, part.decimals, part.sigma)
                : fmt::format("{:<9} not observable in this log: stays as in the robot file\n", part.key);
  }
  text += fmt::format("wheels    left x {:.4f}, right x {:.4f}, track width {:.4f} m (not written)\n",
                      mount.left_scale, mount.right_scale, mount.track_width_m);
  text += fmt::format("misfit    dots {:.3f} px, wheels {:.2f} standard deviations\n", mount.dot_rms_px,
                      mount.wheel_rms);
  return text;
}

nlohmann::ordered_json json_report(const MountSet& set, const MountCalibration& calibration) {
  nlohmann::ordered_json report{{"usable", calibration.flaws.empty()},
                                {"flaws", nlohmann::ordered_json::array()},
                                {"images", set.images},
                                {"images_with_markers", set.frames.size()},
                                {"places", calibration.frames},
                                {"turns", calibration.turns},
                                {"straight_m", calibration.straight_m}};
  for (const MountFlaw flaw : calibration.flaws) report["flaws"].push_back(to_string(flaw));
  if (set.time_offset)
    report["time_offset"] = {{"late_ms", 1e3 * set.time_offset->late_s},
                             {"sigma_ms", 1e3 * set.time_offset->sigma_s}};
  if (calibration.circle) report["circle_radius_m"] = calibration.circle->radius_m;
  if (!calibration.estimate) return report;
  const MountEstimate& mount = *calibration.estimate;
  for (const Part& part : parts_of(mount)) {
    nlohmann::ordered_json& entry = report["camera_mount"][part.key];
    entry = {{"value", part.value}, {"measured", part.measured}};
    if (part.measured) entry["sigma"] = part.sigma;
  }
  report["wheels"] = {{"left_scale", mount.left_scale},
                      {"right_scale", mount.right_scale},
                      {"track_width_m", mount.track_width_m}};
  report["dot_rms_px"] = mount.dot_rms_px;
  report["wheel_rms_sigmas"] = mount.wheel_rms;
  return report;
}

std::vector<std::string> complaints(const MountSet& set, const MountCalibration& calibration,
                                    const MountCalibrationOptions& options) {
  std::vector<std::string> lines;
  for (const MountFlaw flaw : calibration.flaws) {
    lines.push_back(fmt::format("{}: {}", to_string(flaw), complaint(flaw, set, calibration, options)));
  }
  return lines;
}

std::map<std::string, std::string> measured_keys(const MountEstimate& estimate) {
  std::map<std::string, std::string> values;
  for (const Part& part : parts_of(estimate)) {
    if (part.measured) values.emplace(part.key, fmt::format("{:.{}f}", part.value, part.decimals));
  }
  return values;
}

}  // namespace lodestar
