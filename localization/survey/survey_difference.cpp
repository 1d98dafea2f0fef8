#include "localization/survey/survey_difference.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "localization/pose/map_estimate.hpp"
#include "localization/survey/rigid_motion.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

/// A marker of both, in the survey and as registered.
struct Pair {
  const RegisteredMarker* found = nullptr;
  const RegisteredMarker* known = nullptr;
  MarkerSigma sigma;  ///< of both together
};

std::vector<Pair> pairs_of(const MarkerSurvey& survey, const MarkerRegistry& registry,
                           const SurveyDifferenceOptions& options) {
  std::vector<Pair> pairs;
  for (const RegisteredMarker& found : survey.markers) {
    const RegisteredMarker* const known = registry.find(found.id);
    if (known == nullptr) continue;
    const MarkerSigma of_known =
        known->sigma.value_or(MarkerSigma{options.registry_sigma_m, options.registry_sigma_rad});
    const MarkerSigma of_found = found.sigma.value_or(MarkerSigma{});
    pairs.push_back({&found,
                     known,
                     {std::hypot(of_known.position_m, of_found.position_m),
                      std::hypot(of_known.yaw_rad, of_found.yaw_rad)}});
  }
  return pairs;
}

Vec2 xy(const RegisteredMarker& marker) {
  return marker.position_m.head<2>();
}

struct Offset {
  Vec2 way_m;  ///< in the registry's frame
  double turn_rad = 0.0;
};

Offset offset_of(const Pair& pair, const Pose2& registry_from_survey) {
  return {registry_from_survey * xy(*pair.found) - xy(*pair.known),
          wrap_angle(pair.found->yaw_rad + registry_from_survey.yaw_rad - pair.known->yaw_rad)};
}

bool agrees(const Pair& pair, const Offset& offset, const SurveyDifferenceOptions& options) {
  return offset.way_m.norm() <= std::max(options.least_offset_m, options.sigmas * pair.sigma.position_m) &&
         std::abs(offset.turn_rad) <= std::max(options.least_turn_rad, options.sigmas * pair.sigma.yaw_rad);
}

Pose2 best_motion(const std::vector<Pair>& pairs, const std::vector<bool>& used) {
  std::vector<PointPair> points;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (used[i])
      points.push_back({xy(*pairs[i].found), xy(*pairs[i].known), 1.0 / square(pairs[i].sigma.position_m)});
  return best_rigid_motion(points);
}

/// A motion, and which markers agree with it.
struct Agreement {
  Pose2 motion;
  std::vector<bool> agreeing;
  std::ptrdiff_t count = 0;
};

Agreement agreement_with(const std::vector<Pair>& pairs, const Pose2& motion,
                         const SurveyDifferenceOptions& limits) {
  Agreement agreement{.motion = motion, .agreeing = std::vector<bool>(pairs.size())};
  for (std::size_t k = 0; k < pairs.size(); ++k)
    agreement.agreeing[k] = agrees(pairs[k], offset_of(pairs[k], motion), limits);
  agreement.count = std::ranges::count(agreement.agreeing, true);
  return agreement;
}

/// From the motion that two markers propose to the one that all who agree with it decide on together. Two
/// alone give a poor direction, so they agree loosely at first.
Agreement refined(const std::vector<Pair>& pairs, const Pose2& proposed,
                  const SurveyDifferenceOptions& options) {
  constexpr double loose = 4.0;
  constexpr int rounds = 5;
  SurveyDifferenceOptions loosely = options;
  loosely.least_offset_m *= loose;
  loosely.sigmas *= loose;
  Agreement agreement = agreement_with(pairs, proposed, loosely);
  for (int round = 0; round < rounds && agreement.count >= 2; ++round)
    agreement = agreement_with(pairs, best_motion(pairs, agreement.agreeing), options);
  return agreement;
}

/// The motion that most markers agree with: each two of them propose one (RANSAC over all pairs; registries
/// are small, and of large ones a part is tried). Nothing when fewer than two agree.
std::optional<Agreement> best_agreement(const std::vector<Pair>& pairs,
                                        const SurveyDifferenceOptions& options) {
  constexpr std::size_t most_tried = 60;
  const std::size_t stride = std::max<std::size_t>(1, pairs.size() / most_tried);
  Agreement best{.count = 1};
  for (std::size_t i = 0; i < pairs.size(); i += stride) {
    for (std::size_t j = i + stride; j < pairs.size(); j += stride) {
      std::vector<bool> two(pairs.size(), false);
      two[i] = two[j] = true;
      Agreement agreement = refined(pairs, best_motion(pairs, two), options);
      if (agreement.count > best.count) best = std::move(agreement);
    }
  }
  return best.count >= 2 ? std::optional(best) : std::nullopt;
}

RegisteredMarker moved_to_registry(const RegisteredMarker& found, const Pose2& registry_from_survey) {
  RegisteredMarker marker = found;
  marker.position_m.head<2>() = registry_from_survey * xy(found);
  marker.yaw_rad = wrap_angle(found.yaw_rad + registry_from_survey.yaw_rad);
  return marker;
}

MarkerProposal proposal_of(const Pair& pair, const SurveyDifference& difference) {
  const Offset offset = offset_of(pair, difference.registry_from_survey);
  return {.id = pair.found->id,
          .change = MarkerChange::moved,
          .proposed = moved_to_registry(*pair.found, difference.registry_from_survey),
          .offset_m = offset.way_m,
          .turn_rad = offset.turn_rad,
          .sigma_m = pair.sigma.position_m,
          .sigma_rad = pair.sigma.yaw_rad};
}

/// Two moved ones, each where the other is registered.
void name_swapped(std::vector<MarkerProposal>& proposals, const MarkerRegistry& registry,
                  const SurveyDifferenceOptions& options) {
  const auto is_at = [&](const MarkerProposal& proposal, int other) {
    return (xy(proposal.proposed) - xy(*registry.find(other))).norm() < options.swapped_within_m;
  };
  for (MarkerProposal& a : proposals)
    for (MarkerProposal& b : proposals)
      if (a.id < b.id && is_at(a, b.id) && is_at(b, a.id)) a.change = b.change = MarkerChange::swapped;
}

/// How many places of the drive would show the marker whole, were it still there.
int views_of(const RegisteredMarker& marker, const MarkerSurvey& survey, const Pose2& registry_from_survey,
             const CameraModel& camera, double margin_px) {
  constexpr double farthest_m = 10.0;
  int views = 0;
  for (const Pose2& place : survey.path) {
    const Pose2 base = registry_from_survey * place;
    if ((base.position_m - xy(marker)).norm() > farthest_m) continue;
    const Eigen::Isometry3d registry_from_camera = lifted(base) * survey.mount.base_from_camera;
    const bool whole = std::ranges::all_of(dots_of(marker.id), [&](GridCell cell) {
      const Vec2 in_marker = cell_in_marker(cell);
      const Vec3 point = map_from_marker({}, marker) * Vec3(in_marker.x(), in_marker.y(), 0.0);
      const auto seen = project_dot(registry_from_camera, point, camera);
      return seen && camera.contains(seen->pixel, margin_px);
    });
    if (whole) ++views;
  }
  return views;
}

}  // namespace

std::string_view to_string(MarkerChange change) {
  switch (change) {
    case MarkerChange::moved:
      return "moved";
    case MarkerChange::swapped:
      return "swapped";
    case MarkerChange::appeared:
      return "new";
    case MarkerChange::gone:
      return "gone";
  }
  return "";
}

std::optional<SurveyDifference> compare(const MarkerSurvey& survey, const MarkerRegistry& registry,
                                        const CameraModel& camera, const SurveyDifferenceOptions& options) {
  const std::vector<Pair> pairs = pairs_of(survey, registry, options);
  const std::optional<Agreement> agreement = best_agreement(pairs, options);
  if (!agreement) return std::nullopt;
  const Pose2& motion = agreement->motion;
  SurveyDifference difference{.registry_from_survey = motion,
                              .unchanged = static_cast<int>(agreement->count)};
  std::vector<MarkerProposal>& proposals = difference.proposals;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!agreement->agreeing[i]) proposals.push_back(proposal_of(pairs[i], difference));
  name_swapped(proposals, registry, options);
  for (const RegisteredMarker& found : survey.markers) {
    if (registry.find(found.id) != nullptr) continue;
    const MarkerSigma sigma = found.sigma.value_or(MarkerSigma{});
    proposals.push_back({.id = found.id,
                         .change = MarkerChange::appeared,
                         .proposed = moved_to_registry(found, motion),
                         .sigma_m = sigma.position_m,
                         .sigma_rad = sigma.yaw_rad});
  }
  for (const RegisteredMarker& known : registry.markers) {
    const bool is_seen =
        std::ranges::find(survey.markers, known.id, &RegisteredMarker::id) != survey.markers.end();
    if (is_seen || views_of(known, survey, motion, camera, options.view_margin_px) < options.least_views)
      continue;
    proposals.push_back({.id = known.id, .change = MarkerChange::gone, .proposed = known});
  }
  std::ranges::sort(proposals, {}, &MarkerProposal::id);
  return difference;
}

}  // namespace lodestar
