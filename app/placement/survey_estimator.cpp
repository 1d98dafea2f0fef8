#include "app/placement/survey_estimator.hpp"

#include <set>

#include "app/placement/survey_report.hpp"

namespace lodestar {
namespace {

/// What a survey under way is judged by: nothing is too weak to be shown.
SurveyOptions shown_anyhow() {
  SurveyOptions options;
  options.most_sigma_m = 1e3;
  options.most_scale_sigma = 1.0;
  options.most_yaw_sigma_rad = radians(180.0);
  options.least_sightings = 1;
  options.most_keyframes = 1500;  // an estimate every few seconds, in a hall too
  return options;
}

}  // namespace

SurveyEstimator::SurveyEstimator(const Site& site, const std::string& camera,
                                 const SurveyEstimatorOptions& options)
    : options_(options),
      camera_(site.cameras.at(camera)),
      belief_(survey_belief_of(site.robot)),
      registry_(site.registry),
      start_(options.start ? options.start->map_from_base : site.start) {}

void SurveyEstimator::add(SurveyFrame frame) {
  if (!frame.markers.empty()) log_.frames.push_back(std::move(frame));
}

/// The robot has stood at its start until the first frame that shows a marker; what it has rolled by then is
/// in the wheels.
Anchors SurveyEstimator::anchors() const {
  // How long a metre is no drive can tell: the sigmas shown are those that more driving makes smaller.
  Anchors anchors{.print_scale = {1.0, 1e-4}};
  if (!options_.start) return anchors;
  const Stamp placed = log_.wheels.empty() ? log_.frames.front().stamp
                                           : std::max(log_.wheels.front().stamp, log_.frames.front().stamp);
  anchors.anchors.push_back({RobotAnchor{.at_s = seconds(placed),
                                         .position_m = start_.position_m,
                                         .sigma_m = options_.start->sigma_m,
                                         .yaw = AnchorYaw{start_.yaw_rad, options_.start->sigma_rad}},
                             0});
  return anchors;
}

SurveyProgress SurveyEstimator::estimate() {
  SurveyProgress progress{
      .number = ++estimates_, .frames = log_.frames.size(), .target_sigma_m = options_.target_sigma_m};
  if (log_.frames.empty()) return progress;
  progress.survey = survey_markers(std::span(&log_, 1), camera_, belief_, anchors(), shown_anyhow());
  const MarkerSurvey& survey = progress.survey;
  if (survey.markers.empty() || survey.path.empty()) return progress;
  progress.links = weakest_links(survey);
  progress.difference = compare(survey, registry_, camera_);
  progress.is_on_map = options_.start || progress.difference;
  if (!options_.start)
    progress.map_from_survey = progress.difference
                                   ? registry_.map_from_registry * progress.difference->registry_from_survey
                                   : start_ * inverse(survey.path.front());
  return progress;
}

std::vector<int> markers_above_target(const SurveyProgress& progress) {
  std::set<int> ids;
  for (const MarkerLink& link : progress.links)
    if (link.sigma_m > progress.target_sigma_m) ids.insert({link.first, link.second});
  return {ids.begin(), ids.end()};
}

MarkerRegistry registry_so_far(const SurveyProgress& progress) {
  MarkerRegistry registry{.markers = progress.survey.markers};
  for (RegisteredMarker& marker : registry.markers) {
    marker.position_m.head<2>() = progress.map_from_survey * Vec2(marker.position_m.head<2>());
    marker.yaw_rad = wrap_angle(marker.yaw_rad + progress.map_from_survey.yaw_rad);
  }
  return registry;
}

}  // namespace lodestar
