#include "app/console/survey_json.hpp"

#include <algorithm>

#include "app/common/rounding.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

constexpr double to_10_um = 1e5;
constexpr double to_1e4_deg = 1e4;

double metres(double value) {
  return rounded(value, to_10_um);
}

ordered_json marker_json(const SurveyProgress& progress, std::size_t index) {
  const MarkerSurvey& survey = progress.survey;
  const RegisteredMarker& marker = survey.markers[index];
  const Vec2 at = progress.map_from_survey * Vec2(marker.position_m.head<2>());
  ordered_json out{
      {"id", marker.id},
      {"x_m", metres(at.x())},
      {"y_m", metres(at.y())},
      {"yaw_deg",
       rounded(degrees(wrap_angle(marker.yaw_rad + progress.map_from_survey.yaw_rad)), to_1e4_deg)},
      {"sigma_m", marker.sigma ? ordered_json(metres(marker.sigma->position_m)) : ordered_json(nullptr)},
      {"places", survey.sightings[index]}};
  const auto row = 3 * static_cast<Eigen::Index>(index);
  if (survey.covariance.rows() < row + 3) return out;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(progress.map_from_survey.yaw_rad).toRotationMatrix();
  const Eigen::Matrix2d covariance = turn * survey.covariance.block<2, 2>(row, row) * turn.transpose();
  out["covariance_m2"] = {covariance(0, 0), covariance(0, 1), covariance(1, 1)};
  return out;
}

ordered_json proposal_json(const MarkerProposal& proposal, const Pose2& map_from_registry) {
  const Vec2 at = map_from_registry * Vec2(proposal.proposed.position_m.head<2>());
  const Vec2 off = Eigen::Rotation2Dd(map_from_registry.yaw_rad) * proposal.offset_m;
  return {{"id", proposal.id},
          {"change", to_string(proposal.change)},
          {"x_m", metres(at.x())},
          {"y_m", metres(at.y())},
          {"dx_m", metres(off.x())},
          {"dy_m", metres(off.y())},
          {"dyaw_deg", rounded(degrees(proposal.turn_rad), to_1e4_deg)},
          {"sigma_m", metres(proposal.sigma_m)},
          {"marker",
           {{"id", proposal.proposed.id},
            {"x_m", metres(proposal.proposed.position_m.x())},
            {"y_m", metres(proposal.proposed.position_m.y())},
            {"z_m", metres(proposal.proposed.position_m.z())},
            {"yaw_deg", rounded(degrees(proposal.proposed.yaw_rad), to_1e4_deg)}}}};
}

std::vector<int> ids_seen_once(const MarkerSurvey& survey) {
  std::vector<int> ids;
  for (std::size_t i = 0; i < survey.markers.size(); ++i)
    if (survey.sightings[i] < 2) ids.push_back(survey.markers[i].id);
  return ids;
}

std::vector<int> unseen_ids(const SurveyProgress& progress, const MarkerRegistry& registry) {
  std::vector<int> ids;
  for (const RegisteredMarker& marker : registry.markers)
    if (std::ranges::find(progress.survey.markers, marker.id, &RegisteredMarker::id) ==
        progress.survey.markers.end())
      ids.push_back(marker.id);
  return ids;
}

}  // namespace

ordered_json survey_json(const SurveyProgress& progress, const MarkerRegistry& registry) {
  const MarkerSurvey& survey = progress.survey;
  ordered_json out{{"type", "survey"},
                   {"number", progress.number},
                   {"frames", progress.frames},
                   {"on_map", progress.is_on_map},
                   {"target_m", progress.target_sigma_m},
                   {"markers", ordered_json::array()},
                   {"links", ordered_json::array()},
                   {"path", ordered_json::array()},
                   {"flaws", ordered_json::array()},
                   {"rare", ids_seen_once(progress.survey)},
                   {"unseen", unseen_ids(progress, registry)},
                   {"next", nullptr},
                   {"proposals", ordered_json::array()}};
  for (std::size_t i = 0; i < survey.markers.size(); ++i) out["markers"].push_back(marker_json(progress, i));
  for (const SurveyLink& link : survey.links)
    out["links"].push_back({link.first, link.second, link.keyframes});
  for (const Pose2& place : survey.path) {
    const Vec2 at = progress.map_from_survey * place.position_m;
    out["path"].push_back({metres(at.x()), metres(at.y())});
  }
  for (const SurveyRefusal& flaw : survey.flaws)
    out["flaws"].push_back({{"flaw", to_string(flaw.flaw)}, {"found", flaw.found}});
  if (!progress.links.empty()) {
    const MarkerLink& weakest = progress.links.front();
    const Vec2 at = progress.map_from_survey * weakest.between_m;
    out["next"] = {{"x_m", metres(at.x())},
                   {"y_m", metres(at.y())},
                   {"ids", {weakest.first, weakest.second}},
                   {"sigma_m", metres(weakest.sigma_m)}};
  }
  if (progress.difference)
    for (const MarkerProposal& proposal : progress.difference->proposals)
      out["proposals"].push_back(proposal_json(proposal, registry.map_from_registry));
  return out;
}

}  // namespace lodestar
