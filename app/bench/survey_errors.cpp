#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "app/bench/survey_world.hpp"
#include "localization/survey/rigid_motion.hpp"

namespace lodestar {

Pose2 best_rigid_motion(const std::vector<RegisteredMarker>& from, const std::vector<RegisteredMarker>& to) {
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < from.size(); ++i)
    pairs.push_back({from[i].position_m.head<2>(), to[i].position_m.head<2>()});
  return best_rigid_motion(pairs, wrap_angle(to[0].yaw_rad - from[0].yaw_rad));
}

namespace {

double shape_rms_m(const std::vector<RegisteredMarker>& found, const std::vector<RegisteredMarker>& wanted) {
  constexpr double any_scale = 1.0;
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < found.size(); ++i)
    pairs.push_back({found[i].position_m.head<2>(), wanted[i].position_m.head<2>(), 1e6});
  const SimilarMotion move = best_similar_motion(pairs, any_scale);
  double squares = 0.0;
  for (const PointPair& pair : pairs)
    squares += (move * pair.from_m - pair.to_m).squaredNorm() / static_cast<double>(pairs.size());
  return std::sqrt(squares);
}

}  // namespace

SurveyErrors survey_errors(const MarkerSurvey& survey, const std::vector<RegisteredMarker>& truth) {
  std::vector<RegisteredMarker> same;
  for (const RegisteredMarker& marker : survey.markers)
    same.push_back(*std::ranges::find(truth, marker.id, &RegisteredMarker::id));
  const bool is_free = survey.gauge == SurveyGauge::free;
  const Pose2 move = is_free ? best_rigid_motion(survey.markers, same) : Pose2{};
  SurveyErrors errors{.shape_m = shape_rms_m(survey.markers, same)};
  const auto count = static_cast<Eigen::Index>(same.size());
  Eigen::VectorXd error(3 * count);
  // The survey's axes, in which its covariance is.
  const Eigen::Rotation2Dd back(-move.yaw_rad);
  for (Eigen::Index m = 0; m < count; ++m) {
    const RegisteredMarker& found = survey.markers[static_cast<std::size_t>(m)];
    const RegisteredMarker& wanted = same[static_cast<std::size_t>(m)];
    const Vec2 off = move * Vec2(found.position_m.head<2>()) - wanted.position_m.head<2>();
    error.segment<2>(3 * m) = back * off;
    error[3 * m + 2] = wrap_angle(found.yaw_rad + move.yaw_rad - wanted.yaw_rad);
    errors.rms_m += off.squaredNorm() / static_cast<double>(count);
    errors.worst_m = std::max(errors.worst_m, off.norm());
    errors.expected_m += survey.covariance.block<2, 2>(3 * m, 3 * m).trace() / static_cast<double>(count);
  }
  errors.rms_m = std::sqrt(errors.rms_m);
  errors.expected_m = std::sqrt(errors.expected_m);
  // A shape has no covariance along rigid motions: there the inverse is that of the rest.
  Eigen::VectorXd scale = survey.covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation =
      scale.cwiseInverse().asDiagonal() * survey.covariance * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * error.cwiseQuotient(scale);
  for (Eigen::Index i = is_free ? 3 : 0; i < along.size(); ++i)
    errors.nees += square(along[i]) / solver.eigenvalues()[i];
  errors.freedom = static_cast<int>(along.size()) - (is_free ? 3 : 0);
  return errors;
}

}  // namespace lodestar
