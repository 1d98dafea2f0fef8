#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/report/run_record.hpp"

namespace lodestar {

/// How far the estimate was from the truth at one step.
struct EstimateError {
  double time_s = 0.0;
  double position_m = 0.0;
  double heading_rad = 0.0;       ///< signed
  double position_sigma_m = 0.0;  ///< that the estimate claims: the root of its larger variance in the plane
  double heading_sigma_rad = 0.0;
  double nees = 0.0;  ///< normalized estimation error squared, of pose and heading: 3 on average, if honest
};

/// One for each step within the time of the recorded truth, which is interpolated to the estimate's stamp.
std::vector<EstimateError> estimate_errors(const RunRecord& record);

/// The root of the larger variance of a position in the plane.
double larger_sigma(const Eigen::Matrix2d& covariance);

/// Over all steps; nothing where there are none.
std::optional<double> mean_nees(const std::vector<EstimateError>& errors);

/// The true track, parted where a goal was reached or given up.
std::vector<std::vector<TruePose>> parts_of_track(const RunRecord& record);

/// What summary.json says; nothing in it depends on the clock on the wall.
nlohmann::ordered_json summary_of(const RunRecord& record);

}  // namespace lodestar
