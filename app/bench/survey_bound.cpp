#include "app/bench/survey_bound.hpp"

#include <algorithm>
#include <cmath>

#include "localization/survey/anchor_check.hpp"
#include "localization/survey/rigid_motion.hpp"
#include "localization/survey/survey_bundle.hpp"
#include "localization/survey/survey_start.hpp"

namespace lodestar {
namespace {

SurveyBelief true_noise(const SurveyWorld& world) {
  const SurveyWorldOptions& options = world.options;
  SurveyBelief belief = world.belief;
  belief.lean_sigma_rad = options.lean_sigma_rad;
  belief.wheels = {.encoder_sigma_m = options.encoder_step_m / std::sqrt(12.0),  // evenly rounded
                   .slip_sigma_per_sqrt_m = options.slip_sigma_per_sqrt_m,
                   .sideways_sigma_per_sqrt_m = options.sideways_sigma_per_sqrt_m};
  return belief;
}

std::vector<std::size_t> world_indices(const SurveyWorld& world, const SurveyKeyframes& keyframes) {
  std::vector<std::size_t> indices;
  for (const int id : keyframes.ids)
    indices.push_back(static_cast<std::size_t>(std::ranges::find(world.markers, id, &RegisteredMarker::id) -
                                               world.markers.begin()));
  return indices;
}

/// All that the survey estimates, as it is.
SurveyUnknowns true_unknowns(const SurveyWorld& world, const SurveyDrive& drive,
                             const SurveyKeyframes& keyframes) {
  const std::vector<std::size_t> markers = world_indices(world, keyframes);
  const auto frame_of = [&](const SurveyKeyframe& keyframe) {
    const auto found = std::ranges::find(drive.log.frames, keyframe.stamp, &SurveyFrame::stamp);
    return static_cast<std::size_t>(found - drive.log.frames.begin());
  };
  SurveyStart start;
  for (const SurveyKeyframe& keyframe : keyframes.frames)
    start.map_from_base.push_back(drive.map_from_base[frame_of(keyframe)]);
  for (const std::size_t m : markers)
    start.map_from_marker.push_back({world.markers[m].position_m.head<2>(), world.markers[m].yaw_rad});
  SurveyUnknowns unknowns = first_state(keyframes, start, world.belief);
  SurveyState& state = unknowns.state;
  for (std::size_t k = 0; k < state.places.size(); ++k)
    state.places[k].tail<2>() = drive.leans_rad[frame_of(keyframes.frames[k])];
  for (std::size_t i = 0; i < markers.size(); ++i) {
    state.markers[i].z() = world.markers[markers[i]].position_m.z();
    state.markers[i].tail<2>() = world.tilts_rad[markers[i]];
    for (std::size_t dot = 0; dot < unknowns.cells[i].size(); ++dot) {
      const GridCell cell = unknowns.cells[i][dot];
      const auto index = static_cast<std::size_t>(marker_grid_size * cell.row + cell.column);
      state.dot_offsets_m[i].segment<2>(2 * static_cast<Eigen::Index>(dot)) =
          world.dot_offsets_m[markers[i]][index];
    }
  }
  const SurveyWorldOptions& options = world.options;
  state.mount_m = options.base_from_camera.translation();
  const Eigen::AngleAxisd turn(options.base_from_camera.linear() *
                               world.belief.base_from_camera.linear().transpose());
  state.mount_turn_rad = turn.angle() * turn.axis();
  state.scale_and_k1 = {options.print_scale, options.k1_off};
  const double wheels = options.wheel_scales.mean();
  state.wheels = {wheels, 0.5 * (options.wheel_scales[1] - options.wheel_scales[0]) / wheels,
                  options.track_scale * world.belief.track_width_m / wheels};
  state.ceiling[0] = 1.0 / options.ceiling_scale;
  return unknowns;
}

}  // namespace

std::optional<double> survey_bound_m(const SurveyWorld& world, const SurveyDrive& drive,
                                     const Anchors& anchors, const SurveyOptions& options) {
  const std::span<const SurveyLog> logs(&drive.log, 1);
  SurveyOptions of_world = options;
  of_world.marker_tilt_sigma_rad = world.options.marker_tilt_sigma_rad;
  of_world.dot_place_sigma_m = world.options.dot_place_sigma_m;
  const SurveyBelief belief = true_noise(world);
  const SurveyKeyframes keyframes =
      choose_keyframes(logs, kept_stamps(anchors, logs), world.camera, belief, of_world);
  std::vector<SurveyRefusal> flaws;
  const std::vector<PlacedAnchor> placed =
      place_anchors(anchors, logs, keyframes, belief.track_width_m, flaws);
  const SurveyProblem problem{keyframes, world.camera, belief, of_world, anchors, placed};
  SurveyBundle bundle(problem, true_unknowns(world, drive, keyframes));
  if (!placed.empty()) bundle.add_anchors();
  const std::optional<SurveyCovariance> covariance = bundle.covariance();
  if (!covariance) return std::nullopt;
  std::vector<RegisteredMarker> markers;
  std::vector<Eigen::Index> kept;
  for (std::size_t m = 0; m < keyframes.ids.size(); ++m) {
    markers.push_back({.id = keyframes.ids[m], .position_m = bundle.state().markers[m].head<3>()});
    for (const Eigen::Index part : {0, 1, 3}) kept.push_back(4 * static_cast<Eigen::Index>(m) + part);
  }
  Eigen::MatrixXd of_markers = covariance->matrix(kept, kept);
  if (!holds(anchors)) of_markers = shape_covariance(markers, of_markers);
  double squares = 0.0;
  for (Eigen::Index row = 0; row < of_markers.rows(); row += 3)
    squares += of_markers(row, row) + of_markers(row + 1, row + 1);
  return std::sqrt(squares / static_cast<double>(markers.size()));
}

}  // namespace lodestar
