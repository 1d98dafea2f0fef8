#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "localization/survey/placed_anchors.hpp"
#include "localization/survey/survey_state.hpp"
#include "maps/anchors.hpp"

namespace lodestar {

struct SurveyProblem {
  const SurveyKeyframes& keyframes;
  const CameraModel& camera;
  SurveyBelief belief;
  SurveyOptions options;
  const Anchors& anchors;
  std::vector<PlacedAnchor> placed;
};

/// How far residuals of one kind exceed their sigmas.
struct SurveyFit {
  double chi2 = 0.0;     ///< sum of squared residuals in sigmas
  double freedom = 0.0;  ///< its expectation
  [[nodiscard]] double factor() const { return freedom > 0.0 ? chi2 / freedom : 1.0; }
};

/// Squared residuals of what belongs together, and how many there are.
struct ResidualSum {
  double chi2 = 0.0;
  int count = 0;
};

struct SurveyCovariance {
  /// Of the markers' x, y, z and yaw, in their order, and of mount position, mount turn, (print scale, k1)
  /// and wheels behind them: 4 n + 11 rows.
  Eigen::MatrixXd matrix;
  std::vector<double> anchor_redundancies;  ///< of each placed anchor: how much of its error it shows itself
};

/// The least squares over all dots, wheels and anchors: Ceres' Levenberg-Marquardt with sparse normal
/// equations. Only this class and its costs know Ceres.
class SurveyBundle {
 public:
  SurveyBundle(const SurveyProblem& problem, SurveyUnknowns unknowns);
  ~SurveyBundle();

  /// False when dots get behind the camera or the equations have no solution.
  bool solve();

  /// Turns and moves everything so that it fits the anchors best: far from there the least squares would
  /// turn the wrong way.
  void place_registry();

  /// Adds the anchors to what is solved; before, one keyframe holds the registry in its place.
  void add_anchors();

  /// Divides the weights of dots, wheels and the ceiling's motion by these variance factors.
  void set_factors(double dots, double wheels, double ceiling);

  /// The same of what people measured: the anchors and the print's scale.
  void set_gauge_factor(double factor);

  [[nodiscard]] const SurveyState& state() const { return unknowns_.state; }
  /// Twice the cost: all squared residuals.
  [[nodiscard]] double chi2() const;
  [[nodiscard]] SurveyFit fit_of_dots() const;
  [[nodiscard]] SurveyFit fit_of_wheels() const;
  [[nodiscard]] SurveyFit fit_of_ceiling() const;
  /// Of each keyframe's sightings.
  [[nodiscard]] std::vector<std::vector<ResidualSum>> sums_by_sighting() const;
  [[nodiscard]] std::vector<ResidualSum> sums_by_anchor() const;

  /// Nothing when the equations are singular.
  [[nodiscard]] std::optional<SurveyCovariance> covariance() const;

 private:
  struct Ceres;
  [[nodiscard]] Pose2 anchored_from_now() const;
  void add_dots();
  void add_wheels();
  void add_ceiling();
  void add_beliefs();
  void hold(double sigma);
  [[nodiscard]] std::size_t marker_index(int id) const;

  const SurveyProblem& problem_;
  SurveyUnknowns unknowns_;
  std::unique_ptr<Ceres> ceres_;
};

}  // namespace lodestar
