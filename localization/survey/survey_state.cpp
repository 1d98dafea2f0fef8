#include "localization/survey/survey_state.hpp"

#include <algorithm>

#include "maps/median.hpp"

namespace lodestar {

SurveyUnknowns first_state(const SurveyKeyframes& keyframes, const SurveyStart& start,
                           const SurveyBelief& belief) {
  SurveyUnknowns result;
  SurveyState& state = result.state;
  result.cells.resize(keyframes.ids.size());
  std::vector<std::vector<double>> heights_m(keyframes.ids.size());
  for (const SurveyKeyframe& frame : keyframes.frames) {
    for (const KeyframeSighting& sighting : frame.sightings) {
      SeenCells& cells = result.cells[sighting.marker];
      for (const MarkerDot& dot : sighting.dots)
        if (std::ranges::find(cells, dot.cell) == cells.end()) cells.push_back(dot.cell);
      heights_m[sighting.marker].push_back(sighting.above_camera_m);
    }
  }
  for (const Pose2& pose : start.map_from_base) {
    SurveyState::Place place;
    place << pose.position_m, pose.yaw_rad, 0.0, 0.0;
    state.places.push_back(place);
  }
  const double camera_m = belief.base_from_camera.translation().z();
  for (std::size_t m = 0; m < keyframes.ids.size(); ++m) {
    const Pose2& pose = start.map_from_marker[m];
    SurveyState::Marker marker;
    marker << pose.position_m, camera_m + median(heights_m[m]), pose.yaw_rad, 0.0, 0.0;
    state.markers.push_back(marker);
    state.dot_offsets_m.emplace_back(
        Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(result.cells[m].size())));
  }
  state.mount_m << start.mount_m, camera_m;
  state.wheels << start.wheel_scale, start.gauge.difference, start.gauge.track_m;
  return result;
}

}  // namespace lodestar
