#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "app/report/run_record.hpp"

namespace lodestar {

/// The estimate's error against ground truth at one step.
struct EstimateError {
  double time_s = 0.0;
  double position_m = 0.0;
  double heading_rad = 0.0;       ///< signed
  double position_sigma_m = 0.0;  ///< of the estimate, along the larger principal axis
  double heading_sigma_rad = 0.0;
  double nees = 0.0;  ///< normalized estimation error squared, 3 degrees of freedom: mean 3 if consistent
};

/// One for each step within the recorded ground truth, which is interpolated to the estimate's stamp.
std::vector<EstimateError> estimate_errors(const RunRecord& record);

/// Over all steps; nothing where there are none.
std::optional<double> mean_nees(const std::vector<EstimateError>& errors);

/// The true track, split where a goal was reached or given up.
std::vector<std::vector<TruePose>> parts_of_track(const RunRecord& record);

/// Driven along this track.
double length_m(std::span<const TruePose> track);

/// A stretch of the drive in which the robot stood because it had to.
struct Wait {
  Stamp from;
  Stamp to;
  Vec2 position_m = Vec2::Zero();  ///< by the estimate
  std::string why;
};

/// Waits of half a second or more with the pose known, in order.
std::vector<Wait> waits_of(const DriveRecord& record);

/// The content of summary.json; nothing in it depends on wall time.
nlohmann::ordered_json summary_of(const RunRecord& record);

}  // namespace lodestar
