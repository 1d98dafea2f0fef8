#include "localization/survey/marker_survey.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

#include "localization/survey/anchor_check.hpp"
#include "localization/survey/pieces.hpp"
#include "localization/survey/placed_anchors.hpp"
#include "localization/survey/rigid_motion.hpp"
#include "localization/survey/sighting_check.hpp"
#include "localization/survey/survey_bundle.hpp"
#include "maps/rotation_vector.hpp"

namespace lodestar {
namespace {

using Flaws = std::vector<SurveyRefusal>;

std::vector<int> sightings_of(const SurveyKeyframes& keyframes) {
  std::vector<int> counts(keyframes.ids.size(), 0);
  for (const SurveyKeyframe& frame : keyframes.frames)
    for (const KeyframeSighting& sighting : frame.sightings) ++counts[sighting.marker];
  return counts;
}

void refuse_rare_markers(const SurveyKeyframes& keyframes, const std::vector<int>& sightings,
                         const SurveyOptions& options, Flaws& flaws) {
  for (std::size_t m = 0; m < sightings.size(); ++m) {
    if (sightings[m] >= static_cast<int>(options.least_sightings)) continue;
    flaws.push_back({SurveyFlaw::too_few_sightings,
                     fmt::format("marker {}: seen from {} of the {} places needed", keyframes.ids[m],
                                 sightings[m], options.least_sightings),
                     keyframes.ids[m]});
  }
}

/// Names some markers of the two largest parts.
SurveyRefusal not_connected(const SurveyKeyframes& keyframes, const SurveyPieces& pieces) {
  std::map<std::size_t, std::set<int>> ids;
  for (std::size_t k = 0; k < keyframes.frames.size(); ++k)
    for (const KeyframeSighting& sighting : keyframes.frames[k].sightings)
      ids[pieces.of_keyframe[k]].insert(keyframes.ids[sighting.marker]);
  std::string words =
      fmt::format("{} parts that neither wheels nor a marker seen from both join:", pieces.count);
  constexpr std::size_t named = 3;
  for (const auto& [piece, members] : ids) {
    if (piece >= named) break;
    words += fmt::format("{} the one with marker {}{}", piece == 0 ? "" : ",", *members.begin(),
                         members.size() > 1 ? fmt::format(" and {} more", members.size() - 1) : "");
  }
  return {SurveyFlaw::not_connected, words};
}

std::vector<SurveyLink> links_of(const SurveyKeyframes& keyframes) {
  std::map<std::pair<int, int>, int> counts;
  for (const SurveyKeyframe& frame : keyframes.frames)
    for (const KeyframeSighting& a : frame.sightings)
      for (const KeyframeSighting& b : frame.sightings)
        if (a.marker < b.marker) ++counts[{keyframes.ids[a.marker], keyframes.ids[b.marker]}];
  std::vector<SurveyLink> links;
  for (const auto& [ids, count] : counts) links.push_back({ids.first, ids.second, count});
  return links;
}

/// Solves, and lets the residuals say how much noisier dots and wheels are than believed (variance
/// components).
bool solve_with_factors(SurveyBundle& bundle, MarkerSurvey& survey) {
  constexpr int rounds = 3;
  constexpr double same = 1.1;
  for (int round = 0; round < rounds; ++round) {
    if (!bundle.solve()) return false;
    const double dots = std::max(1.0, bundle.fit_of_dots().factor());
    const double wheels = std::max(1.0, bundle.fit_of_wheels().factor());
    const double ceiling = std::max(1.0, bundle.fit_of_ceiling().factor());
    const auto is_same = [](double a, double b) { return a < same * b && b < same * a; };
    const bool settled = is_same(dots, survey.dots_factor) && is_same(wheels, survey.wheels_factor) &&
                         is_same(ceiling, survey.ceiling_factor);
    survey.dots_factor = dots;
    survey.wheels_factor = wheels;
    survey.ceiling_factor = ceiling;
    if (settled) return true;
    bundle.set_factors(dots, wheels, ceiling);
  }
  return bundle.solve();
}

/// Adds the anchors, and lets their misfit say how much worse than said they and the print were measured:
/// what is too little to refuse is not too little to doubt.
bool solve_with_anchors(const SurveyProblem& problem, SurveyBundle& bundle, MarkerSurvey& survey) {
  const double chi2_without = bundle.chi2();
  bundle.place_registry();
  bundle.add_anchors();
  if (!bundle.solve()) return false;
  const SurveyFit fit = fit_of_anchors(problem, bundle, chi2_without);
  if (const auto refusal = false_anchor(problem, bundle, fit)) survey.flaws.push_back(*refusal);
  survey.gauge_factor = std::max(1.0, fit.factor());
  bundle.set_gauge_factor(survey.gauge_factor);
  return bundle.solve();
}

/// Squared residuals of each marker's dots over their number.
std::vector<double> dots_fit(const SurveyKeyframes& keyframes, const SurveyBundle& bundle) {
  std::vector<ResidualSum> sums(keyframes.ids.size());
  const auto by_sighting = bundle.sums_by_sighting();
  for (std::size_t k = 0; k < by_sighting.size(); ++k) {
    for (std::size_t i = 0; i < by_sighting[k].size(); ++i) {
      ResidualSum& sum = sums[keyframes.frames[k].sightings[i].marker];
      sum.chi2 += by_sighting[k][i].chi2;
      sum.count += by_sighting[k][i].count;
    }
  }
  std::vector<double> fits;
  for (const ResidualSum& sum : sums) fits.push_back(sum.count > 0 ? sum.chi2 / sum.count : 0.0);
  return fits;
}

void refuse_contradictions(const SurveyKeyframes& keyframes, const SurveyOptions& options,
                           const MarkerSurvey& survey, Flaws& flaws) {
  const auto worst = std::ranges::max_element(survey.dots_fit);
  const int worst_id = keyframes.ids[static_cast<std::size_t>(worst - survey.dots_fit.begin())];
  if (survey.dots_factor > options.most_dots_factor) {
    flaws.push_back(
        {SurveyFlaw::contradiction,
         fmt::format("dots are off by {:.1f} times their sigmas (chi2/dof {:.2f}), most of all marker {}'s",
                     std::sqrt(survey.dots_factor), survey.dots_factor, worst_id)});
  } else if (*worst > options.most_marker_factor) {
    flaws.push_back(
        {SurveyFlaw::contradiction,
         fmt::format("marker {}: its dots are off by {:.1f} times their sigmas, as if it had moved", worst_id,
                     std::sqrt(*worst))});
  }
  if (survey.wheels_factor > options.most_wheels_factor) {
    flaws.push_back(
        {SurveyFlaw::contradiction,
         fmt::format("wheels are off by {:.1f} times their sigmas (chi2/dof {:.1f}): slip, exchanged "
                     "sides, or a clock of their own",
                     std::sqrt(survey.wheels_factor), survey.wheels_factor)});
  }
}

void take_registry(const SurveyKeyframes& keyframes, const SurveyState& state, const SurveyBelief& belief,
                   MarkerSurvey& survey) {
  // Heights are known from the camera's; its own is the robot file's.
  const double lift_m = belief.base_from_camera.translation().z() - state.mount_m.z();
  for (std::size_t m = 0; m < keyframes.ids.size(); ++m) {
    const SurveyState::Marker& marker = state.markers[m];
    survey.markers.push_back({.id = keyframes.ids[m],
                              .position_m = marker.head<3>() + Vec3(0.0, 0.0, lift_m),
                              .yaw_rad = wrap_angle(marker[3])});
  }
  for (const SurveyState::Place& place : state.places)
    survey.path.push_back({place.head<2>(), wrap_angle(place[2])});
}

void take_robot(const SurveyState& state, const SurveyBelief& belief, MarkerSurvey& survey) {
  SurveyedMount& mount = survey.mount;
  mount.base_from_camera = belief.base_from_camera;
  mount.base_from_camera.linear() = rotation_by(state.mount_turn_rad) * belief.base_from_camera.linear();
  mount.base_from_camera.translation().head<2>() = state.mount_m.head<2>();
  mount.left_scale = state.wheels[0] * (1.0 - state.wheels[1]);
  mount.right_scale = state.wheels[0] * (1.0 + state.wheels[1]);
  mount.track_width_m = state.wheels[0] * state.wheels[2];
  survey.print_scale = state.scale_and_k1[0];
  survey.k1_off = state.scale_and_k1[1];
}

double sigma_at(const Eigen::MatrixXd& covariance, Eigen::Index i) {
  return std::sqrt(covariance(i, i));
}

/// Covariances: of x, y and yaw of the markers, and the single sigmas of the rest.
void take_covariance(const Eigen::MatrixXd& all, MarkerSurvey& survey) {
  const auto markers = static_cast<Eigen::Index>(survey.markers.size());
  std::vector<Eigen::Index> kept;
  for (Eigen::Index m = 0; m < markers; ++m)
    for (const Eigen::Index part : {0, 1, 3}) kept.push_back(4 * m + part);
  survey.covariance = all(kept, kept);
  const Eigen::Index shared = 4 * markers;
  for (Eigen::Index i = 0; i < 3; ++i) {
    survey.mount.position_sigmas_m[i] = sigma_at(all, shared + i);
    survey.mount.angle_sigmas_rad[i] = sigma_at(all, shared + 3 + i);
  }
  survey.print_scale_sigma = sigma_at(all, shared + 6);
  survey.k1_sigma = sigma_at(all, shared + 7);
}

/// What the person who asked cannot use.
void refuse_weak(const SurveyOptions& options, MarkerSurvey& survey, Flaws& flaws) {
  if (survey.print_scale_sigma > options.most_scale_sigma) {
    flaws.push_back({SurveyFlaw::scale_unknown,
                     fmt::format("the scale is known to {:.2f} % only", 100.0 * survey.print_scale_sigma)});
  }
  if (survey.gauge == SurveyGauge::anchored) {
    const double sigma = turn_sigma_rad(survey.markers, survey.covariance);
    if (sigma > options.most_yaw_sigma_rad) {
      flaws.push_back(
          {SurveyFlaw::orientation_unknown,
           sigma > radians(90.0)
               ? fmt::format("anchors say nothing of the registry's direction")
               : fmt::format("the registry's direction is known to {:.1f} degrees only", degrees(sigma))});
      return;  // every sigma would be that one
    }
  } else {
    survey.covariance = shape_covariance(survey.markers, survey.covariance);
  }
  double worst_m = 0.0;
  int worst_id = 0;
  for (std::size_t m = 0; m < survey.markers.size(); ++m) {
    const auto at = 3 * static_cast<Eigen::Index>(m);
    const double sigma_m = larger_sigma(survey.covariance.block<2, 2>(at, at));
    survey.markers[m].sigma = MarkerSigma{sigma_m, sigma_at(survey.covariance, at + 2)};
    if (sigma_m <= worst_m) continue;
    worst_m = sigma_m;
    worst_id = survey.markers[m].id;
  }
  if (worst_m > options.most_sigma_m)
    flaws.push_back(
        {SurveyFlaw::weak, fmt::format("marker {} is known to {:.1f} mm only, wanted are {:.1f} mm", worst_id,
                                       mm_per_m * worst_m, mm_per_m * options.most_sigma_m)});
}

}  // namespace

std::string_view to_string(SurveyFlaw flaw) {
  switch (flaw) {
    case SurveyFlaw::too_few_sightings:
      return "too-few-sightings";
    case SurveyFlaw::not_connected:
      return "not-connected";
    case SurveyFlaw::scale_unknown:
      return "scale-unknown";
    case SurveyFlaw::orientation_unknown:
      return "orientation-unknown";
    case SurveyFlaw::weak:
      return "weak";
    case SurveyFlaw::contradiction:
      return "contradiction";
    case SurveyFlaw::anchors_contradict:
      return "anchors-contradict";
    case SurveyFlaw::same_id_twice:
      return "same-id-twice";
    case SurveyFlaw::no_convergence:
      return "no-convergence";
  }
  return "";
}

MarkerSurvey survey_markers(std::span<const SurveyLog> logs, const CameraModel& camera,
                            const SurveyBelief& belief, const Anchors& anchors,
                            const SurveyOptions& options) {
  MarkerSurvey survey;
  Flaws& flaws = survey.flaws;
  const auto refuse = [&flaws](SurveyFlaw flaw, std::string_view found) {
    flaws.push_back({flaw, fmt::format("{}", found)});
  };
  const SurveyKeyframes keyframes =
      choose_keyframes(logs, kept_stamps(anchors, logs), camera, belief, options);
  if (keyframes.frames.empty()) {
    refuse(SurveyFlaw::too_few_sightings, "no frame shows a marker");
    return survey;
  }
  survey.gauge = holds(anchors) ? SurveyGauge::anchored : SurveyGauge::free;
  if (const SurveyPieces pieces = pieces_of(keyframes); pieces.count > 1)
    flaws.push_back(not_connected(keyframes, pieces));
  refuse_rare_markers(keyframes, sightings_of(keyframes), options, flaws);
  const std::vector<PlacedAnchor> placed =
      place_anchors(anchors, logs, keyframes, belief.track_width_m, flaws);
  if (!flaws.empty()) return survey;

  const std::optional<SurveyStart> start = start_survey(keyframes, belief, options);
  if (start) {
    if (const auto refusal = check_sightings(keyframes, *start)) flaws.push_back(*refusal);
  } else {
    refuse(SurveyFlaw::no_convergence, "frames and wheels do not determine a start");
  }
  if (!flaws.empty()) return survey;

  const SurveyProblem problem{keyframes, camera, belief, options, anchors, placed};
  SurveyBundle bundle(problem, first_state(keyframes, *start, belief));
  const bool is_settled = solve_with_factors(bundle, survey);
  survey.keyframes = keyframes.frames.size();
  survey.sightings = sightings_of(keyframes);
  survey.links = links_of(keyframes);
  // What contradicts itself may not settle either: the contradiction is the better word.
  survey.dots_fit = dots_fit(keyframes, bundle);
  refuse_contradictions(keyframes, options, survey, flaws);
  if (!is_settled && flaws.empty()) refuse(SurveyFlaw::no_convergence, "the least squares do not settle");
  if (!flaws.empty()) return survey;

  if (!placed.empty() && !solve_with_anchors(problem, bundle, survey)) {
    refuse(SurveyFlaw::no_convergence, "the least squares with anchors do not settle");
    return survey;
  }
  take_registry(keyframes, bundle.state(), belief, survey);
  take_robot(bundle.state(), belief, survey);
  if (options.before_covariance) options.before_covariance();
  const std::optional<SurveyCovariance> covariance = bundle.covariance();
  if (!covariance) {
    refuse(SurveyFlaw::no_convergence, "the least squares leave unknowns undetermined");
    return survey;
  }
  take_covariance(covariance->matrix, survey);
  if (!placed.empty()) check_anchors(problem, bundle, covariance->anchor_redundancies, survey);
  refuse_weak(options, survey, flaws);
  return survey;
}

}  // namespace lodestar
