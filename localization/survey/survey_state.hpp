#pragma once

#include <Eigen/Core>
#include <vector>

#include "localization/survey/keyframes.hpp"
#include "localization/survey/survey_start.hpp"

namespace lodestar {

/// The cells in which a marker's dots were seen, in the order of its unknown dot places.
using SeenCells = std::vector<GridCell>;

/// All unknowns of the survey's least squares.
struct SurveyState {
  /// x, y, yaw, and the body's lean about the base's x and y axes.
  using Place = Eigen::Matrix<double, 5, 1>;
  /// x, y, z of dot O's nominal place, yaw, and tilt about the x and y axes of the marker as seen from above.
  using Marker = Eigen::Matrix<double, 6, 1>;

  std::vector<Place> places;
  std::vector<Marker> markers;
  std::vector<Eigen::VectorXd> dot_offsets_m;  ///< of each marker: x and y of each seen dot, in its plane
  Vec3 mount_m = Vec3::Zero();
  Vec3 mount_turn_rad = Vec3::Zero();  ///< about the base's axes, from the believed rotation
  Vec2 scale_and_k1 = Vec2(1.0, 0.0);  ///< of the print; and what k1 is off by
  /// Metres per metre of the ceiling's own motion: how high it is, besides what was believed.
  Eigen::Matrix<double, 1, 1> ceiling = Eigen::Matrix<double, 1, 1>::Ones();
  Vec3 wheels = Vec3::Ones();  ///< metres per reported metre, difference, track in reported metres
};

/// The state that a start gives, and the cells of each marker.
struct SurveyUnknowns {
  SurveyState state;
  std::vector<SeenCells> cells;
};
SurveyUnknowns first_state(const SurveyKeyframes& keyframes, const SurveyStart& start,
                           const SurveyBelief& belief);

}  // namespace lodestar
