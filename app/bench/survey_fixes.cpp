#include "app/bench/survey_fixes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "localization/pose/mount.hpp"
#include "localization/pose/pose_fixer.hpp"

namespace lodestar {
namespace {

PoseFixOptions fix_options(const SurveyWorld& world) {
  PoseFixOptions options;
  options.prior.tilt = world.options.base_from_camera.linear();
  options.prior.tilt_sigma_rad = world.options.lean_sigma_rad;
  options.dot_sigma_px = world.options.dot_sigma_px;
  options.dot_place_sigma_m = world.options.dot_place_sigma_m;
  return options;
}

MarkerRegistry laid_onto(const MarkerSurvey& survey, const std::vector<RegisteredMarker>& truth) {
  std::vector<RegisteredMarker> same;
  for (const RegisteredMarker& marker : survey.markers)
    same.push_back(*std::ranges::find(truth, marker.id, &RegisteredMarker::id));
  const Pose2 move = best_rigid_motion(survey.markers, same);
  MarkerRegistry registry{.markers = survey.markers};
  for (RegisteredMarker& marker : registry.markers) {
    marker.position_m.head<2>() = move * Vec2(marker.position_m.head<2>());
    marker.yaw_rad = wrap_angle(marker.yaw_rad + move.yaw_rad);
  }
  return registry;
}

}  // namespace

FixErrors fix_errors(const SurveyWorld& world, const MarkerSurvey& survey, const std::vector<Vec2>& way_m,
                     std::uint64_t seed) {
  constexpr std::uint64_t another_day = 7919;
  constexpr std::size_t every = 3;
  const SurveyDrive drive = drive_survey(world, way_m, seed + another_day);
  PoseFixer surveyed(laid_onto(survey, world.markers), world.camera);
  PoseFixer true_one(MarkerRegistry{.markers = world.markers}, world.camera);
  const PoseFixOptions options = fix_options(world);
  FixErrors errors;
  for (std::size_t i = 0; i < drive.log.frames.size(); i += every) {
    const std::vector<DetectedMarker> markers = whole_markers(drive.log.frames[i]);
    const auto squared_error = [&](PoseFixer& fixer) -> std::optional<double> {
      const PoseFix* const fix = fixer.fix(drive.log.frames[i].stamp, markers, options);
      if (fix == nullptr) return std::nullopt;
      const auto planar = compensate_mount(*fix, world.options.base_from_camera);
      return (planar.map_from_base.position_m - drive.map_from_base[i].position_m).squaredNorm();
    };
    const std::optional<double> by_survey = squared_error(surveyed);
    const std::optional<double> by_truth = squared_error(true_one);
    errors.lost += by_truth && !by_survey ? 1 : 0;
    if (!by_survey || !by_truth) continue;
    ++errors.fixes;
    errors.by_survey_m += *by_survey;
    errors.by_truth_m += *by_truth;
  }
  errors.by_survey_m = std::sqrt(errors.by_survey_m / std::max(1, errors.fixes));
  errors.by_truth_m = std::sqrt(errors.by_truth_m / std::max(1, errors.fixes));
  return errors;
}

}  // namespace lodestar
