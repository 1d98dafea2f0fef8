#include "localization/survey/survey_difference.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "localization/pose/map_estimate.hpp"
#include "localization/survey/rigid_motion.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

constexpr double least_sigma_m = 1e-5;  // nobody knows more

/// A marker of both, in the survey and as registered.
struct Pair {
  const RegisteredMarker* found = nullptr;
  const RegisteredMarker* known = nullptr;
  MarkerSigma sigma;  ///< of both together
};

MarkerSigma sigma_of(const Eigen::MatrixXd& covariance, std::size_t marker) {
  const auto at = 3 * static_cast<Eigen::Index>(marker);
  return {larger_sigma(covariance.block<2, 2>(at, at)), std::sqrt(covariance(at + 2, at + 2))};
}

/// What a marker's place in the survey's shape is known to, once shape and registry are aligned: of the scale
/// that leaves what the alignment cannot tell from its belief.
std::vector<MarkerSigma> sigmas_in_shape(const MarkerSurvey& survey, double scale_sigma) {
  std::vector<MarkerSigma> sigmas;
  const auto at_share = [&](double share) {
    const Eigen::MatrixXd shape = shape_covariance(survey.markers, survey.covariance, share);
    sigmas.clear();
    for (std::size_t m = 0; m < survey.markers.size(); ++m) sigmas.push_back(sigma_of(shape, m));
  };
  at_share(1.0);
  Vec2 middle_m = Vec2::Zero();
  for (const RegisteredMarker& marker : survey.markers)
    middle_m += marker.position_m.head<2>() / static_cast<double>(survey.markers.size());
  double told = 0.0;
  for (std::size_t m = 0; m < sigmas.size(); ++m)
    told += (survey.markers[m].position_m.head<2>() - middle_m).squaredNorm() /
            square(std::max(sigmas[m].position_m, least_sigma_m));
  at_share(told / (told + 1.0 / square(scale_sigma)));
  return sigmas;
}

std::vector<Pair> pairs_of(const MarkerSurvey& survey, const MarkerRegistry& registry, double scale_sigma,
                           const SurveyDifferenceOptions& options) {
  const std::vector<MarkerSigma> sigmas = sigmas_in_shape(survey, scale_sigma);
  std::vector<Pair> pairs;
  for (std::size_t m = 0; m < survey.markers.size(); ++m) {
    const RegisteredMarker& found = survey.markers[m];
    const RegisteredMarker* const known = registry.find(found.id);
    if (known == nullptr) continue;
    const MarkerSigma of_known =
        known->sigma.value_or(MarkerSigma{options.registry_sigma_m, options.registry_sigma_rad});
    const MarkerSigma& of_found = sigmas[m];
    pairs.push_back({&found,
                     known,
                     {std::max(least_sigma_m, std::hypot(of_known.position_m, of_found.position_m)),
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

Offset offset_of(const Pair& pair, const SimilarMotion& registry_from_survey) {
  return {registry_from_survey * xy(*pair.found) - xy(*pair.known),
          wrap_angle(pair.found->yaw_rad + registry_from_survey.motion.yaw_rad - pair.known->yaw_rad)};
}

bool agrees(const Pair& pair, const Offset& offset, const SurveyDifferenceOptions& options) {
  return offset.way_m.norm() <= std::max(options.least_offset_m, options.sigmas * pair.sigma.position_m) &&
         std::abs(offset.turn_rad) <= std::max(options.least_turn_rad, options.sigmas * pair.sigma.yaw_rad);
}

SimilarMotion best_motion(const std::vector<Pair>& pairs, const std::vector<bool>& used, double scale_sigma) {
  std::vector<PointPair> points;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (used[i])
      points.push_back({xy(*pairs[i].found), xy(*pairs[i].known), 1.0 / square(pairs[i].sigma.position_m)});
  return best_similar_motion(points, scale_sigma);
}

/// A motion, and which markers agree with it.
struct Agreement {
  SimilarMotion motion;
  std::vector<bool> agreeing;
  std::ptrdiff_t count = 0;
};

Agreement agreement_with(const std::vector<Pair>& pairs, const SimilarMotion& motion,
                         const SurveyDifferenceOptions& limits) {
  Agreement agreement{.motion = motion, .agreeing = std::vector<bool>(pairs.size())};
  for (std::size_t k = 0; k < pairs.size(); ++k)
    agreement.agreeing[k] = agrees(pairs[k], offset_of(pairs[k], motion), limits);
  agreement.count = std::ranges::count(agreement.agreeing, true);
  return agreement;
}

/// From the motion that two markers propose to the one that all who agree with it decide on together. Two
/// alone give a poor direction, so they agree loosely at first.
Agreement refined(const std::vector<Pair>& pairs, const SimilarMotion& proposed, double scale_sigma,
                  const SurveyDifferenceOptions& options) {
  constexpr double loose = 4.0;
  constexpr int rounds = 5;
  SurveyDifferenceOptions loosely = options;
  loosely.least_offset_m *= loose;
  loosely.sigmas *= loose;
  Agreement agreement = agreement_with(pairs, proposed, loosely);
  for (int round = 0; round < rounds && agreement.count >= 2; ++round)
    agreement = agreement_with(pairs, best_motion(pairs, agreement.agreeing, scale_sigma), options);
  return agreement;
}

/// The motion that most markers agree with: each two of them propose one (RANSAC over all pairs; registries
/// are small, and of large ones a part is tried). Nothing when fewer than two agree.
std::optional<Agreement> best_agreement(const std::vector<Pair>& pairs, double scale_sigma,
                                        const SurveyDifferenceOptions& options) {
  constexpr std::size_t most_tried = 60;
  const std::size_t stride = std::max<std::size_t>(1, pairs.size() / most_tried);
  Agreement best{.count = 1};
  for (std::size_t i = 0; i < pairs.size(); i += stride) {
    for (std::size_t j = i + stride; j < pairs.size(); j += stride) {
      std::vector<bool> two(pairs.size(), false);
      two[i] = two[j] = true;
      Agreement agreement = refined(pairs, best_motion(pairs, two, scale_sigma), scale_sigma, options);
      if (agreement.count > best.count) best = std::move(agreement);
    }
  }
  return best.count >= 2 ? std::optional(best) : std::nullopt;
}

RegisteredMarker moved_to_registry(const RegisteredMarker& found, const SimilarMotion& registry_from_survey) {
  RegisteredMarker marker = found;
  marker.position_m.head<2>() = registry_from_survey * xy(found);
  marker.yaw_rad = wrap_angle(found.yaw_rad + registry_from_survey.motion.yaw_rad);
  return marker;
}

MarkerProposal proposal_of(const Pair& pair, const SimilarMotion& registry_from_survey) {
  const Offset offset = offset_of(pair, registry_from_survey);
  return {.id = pair.found->id,
          .change = MarkerChange::moved,
          .proposed = moved_to_registry(*pair.found, registry_from_survey),
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
int views_of(const RegisteredMarker& marker, const MarkerSurvey& survey,
             const SimilarMotion& registry_from_survey, const CameraModel& camera, double margin_px) {
  constexpr double farthest_m = 10.0;
  int views = 0;
  for (const Pose2& place : survey.path) {
    const Pose2 base{registry_from_survey * place.position_m,
                     registry_from_survey.motion.yaw_rad + place.yaw_rad};
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
  const auto rows = 3 * static_cast<Eigen::Index>(survey.markers.size());
  if (rows == 0 || survey.covariance.rows() != rows) return std::nullopt;
  const double scale_sigma = std::hypot(survey.print_scale_sigma, options.registry_scale_sigma);
  const std::vector<Pair> pairs = pairs_of(survey, registry, scale_sigma, options);
  const std::optional<Agreement> agreement = best_agreement(pairs, scale_sigma, options);
  if (!agreement) return std::nullopt;
  const SimilarMotion& motion = agreement->motion;
  SurveyDifference difference{.registry_from_survey = motion.motion,
                              .scale = motion.scale,
                              .unchanged = static_cast<int>(agreement->count)};
  std::vector<MarkerProposal>& proposals = difference.proposals;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!agreement->agreeing[i]) proposals.push_back(proposal_of(pairs[i], motion));
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
