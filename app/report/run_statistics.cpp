#include "app/report/run_statistics.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

using Json = nlohmann::ordered_json;

Pose2 between(const TruePose& before, const TruePose& after, Stamp stamp) {
  const Duration step = after.stamp - before.stamp;
  const double share = step > Duration::zero() ? seconds(stamp - before.stamp) / seconds(step) : 0.0;
  const double turn = wrap_angle(after.map_from_base.yaw_rad - before.map_from_base.yaw_rad);
  return {before.map_from_base.position_m +
              share * (after.map_from_base.position_m - before.map_from_base.position_m),
          wrap_angle(before.map_from_base.yaw_rad + share * turn)};
}

double nees_of(const PoseEstimate& estimate, const Pose2& truth) {
  Vec3 error;
  error << truth.position_m - estimate.map_from_base.position_m,
      wrap_angle(truth.yaw_rad - estimate.map_from_base.yaw_rad);
  return error.dot(estimate.covariance.ldlt().solve(error));
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json spread_of(const std::vector<double>& values) {
  return {{"p50", optional_json(percentile(values, 0.5))},
          {"p95", optional_json(percentile(values, 0.95))},
          {"max", optional_json(percentile(values, 1.0))}};
}

Json goal_json(const GoalRecord& record, const std::optional<ArrivalScore>& score) {
  std::optional<double> heading_deg;
  if (record.goal.heading_rad) heading_deg = degrees(*record.goal.heading_rad);
  std::optional<double> position_error;
  std::optional<double> heading_error_deg;
  if (score) {
    position_error = score->position_error_m;
    if (score->heading_error_rad) heading_error_deg = degrees(*score->heading_error_rad);
  }
  const std::size_t waypoints = record.planned.waypoints_m.size();
  return {{"x_m", record.goal.position_m.x()},
          {"y_m", record.goal.position_m.y()},
          {"heading_deg", optional_json(heading_deg)},
          {"arrived", record.arrived},
          {"failure", record.failure},
          {"planned_length_m", length_m(record.planned)},
          {"turns", waypoints > 2 ? waypoints - 2 : 0},
          {"travel_time_s", seconds(record.travel_time)},
          {"ended_s", seconds(record.ended)},
          {"position_error_m", optional_json(position_error)},
          {"heading_error_deg", optional_json(heading_error_deg)}};
}

Json distrusted_json(const std::vector<DistrustedMarker>& distrusted) {
  Json markers = Json::array();
  for (const DistrustedMarker& marker : distrusted) {
    markers.push_back({{"id", marker.id},
                       {"offset_x_m", marker.offset_m.x()},
                       {"offset_y_m", marker.offset_m.y()},
                       {"turn_deg", degrees(marker.turn_rad)},
                       {"fixes", marker.fixes}});
  }
  return markers;
}

Json waits_json(const std::vector<Wait>& waits) {
  Json list = Json::array();
  for (const Wait& wait : waits) {
    list.push_back({{"from_s", seconds(wait.from)},
                    {"duration_s", seconds(wait.to - wait.from)},
                    {"x_m", wait.position_m.x()},
                    {"y_m", wait.position_m.y()},
                    {"why", wait.why}});
  }
  return list;
}

Json notices_json(const std::vector<NoticeRecord>& notices) {
  Json list = Json::array();
  for (const NoticeRecord& notice : notices)
    list.push_back({{"at_s", seconds(notice.stamp)}, {"words", notice.words}, {"stops", notice.stops}});
  return list;
}

Json faults_json(const std::vector<FaultEvent>& faults) {
  Json list = Json::array();
  for (const FaultEvent& fault : faults) {
    list.push_back({{"fault", to_string(fault.kind)},
                    {"begin_s", seconds(fault.begin)},
                    {"end_s", fault.end ? Json(seconds(*fault.end)) : Json(nullptr)},
                    {"marker", fault.marker ? Json(*fault.marker) : Json(nullptr)}});
  }
  return list;
}

double duration_s(const RunRecord& record) {
  if (record.steps.empty()) return 0.0;
  return seconds(record.steps.back().estimate.stamp - record.steps.front().estimate.stamp);
}

std::optional<double> largest_sigma_m(const RunRecord& record) {
  std::optional<double> largest;
  for (const StepRecord& step : record.steps)
    largest = std::max(largest.value_or(0.0), larger_sigma(step.estimate.covariance.topLeftCorner<2, 2>()));
  return largest;
}

/// By the truth, or by the estimate where nobody knows that.
double driven_m(const RunRecord& record) {
  if (!record.truth.empty()) return length_m(record.truth);
  double total = 0.0;
  for (std::size_t i = 1; i < record.steps.size(); ++i)
    total += (record.steps[i].estimate.map_from_base.position_m -
              record.steps[i - 1].estimate.map_from_base.position_m)
                 .norm();
  return total;
}

double mean_confidence(const RunRecord& record) {
  double sum = 0.0;
  for (const FixRecord& fix : record.fixes) sum += fix.confidence;
  return record.fixes.empty() ? 0.0 : sum / static_cast<double>(record.fixes.size());
}

}  // namespace

std::vector<std::vector<TruePose>> parts_of_track(const RunRecord& record) {
  std::vector<std::vector<TruePose>> parts(1);
  for (const TruePose& pose : record.truth) {
    while (parts.size() < record.goals.size() && pose.stamp > record.goals[parts.size() - 1].ended) {
      parts.emplace_back();
    }
    parts.back().push_back(pose);
  }
  return parts;
}

double length_m(std::span<const TruePose> track) {
  double total_m = 0.0;
  for (std::size_t i = 1; i < track.size(); ++i)
    total_m += (track[i].map_from_base.position_m - track[i - 1].map_from_base.position_m).norm();
  return total_m;
}

std::vector<EstimateError> estimate_errors(const RunRecord& record) {
  std::vector<EstimateError> errors;
  std::size_t after = 1;
  for (const StepRecord& step : record.steps) {
    const PoseEstimate& estimate = step.estimate;
    while (after < record.truth.size() && record.truth[after].stamp < estimate.stamp) ++after;
    if (after >= record.truth.size()) break;
    const Pose2 truth = between(record.truth[after - 1], record.truth[after], estimate.stamp);
    errors.push_back({.time_s = seconds(estimate.stamp),
                      .position_m = (estimate.map_from_base.position_m - truth.position_m).norm(),
                      .heading_rad = wrap_angle(estimate.map_from_base.yaw_rad - truth.yaw_rad),
                      .position_sigma_m = larger_sigma(estimate.covariance.topLeftCorner<2, 2>()),
                      .heading_sigma_rad = std::sqrt(estimate.covariance(2, 2)),
                      .nees = nees_of(estimate, truth)});
  }
  return errors;
}

std::optional<double> mean_nees(const std::vector<EstimateError>& errors) {
  if (errors.empty()) return std::nullopt;
  double sum = 0.0;
  for (const EstimateError& error : errors) sum += error.nees;
  return sum / static_cast<double>(errors.size());
}

std::vector<Wait> waits_of(const DriveRecord& record) {
  constexpr Duration shortest = std::chrono::milliseconds(500);
  std::vector<Wait> waits;
  for (std::size_t i = 0; i < record.notices.size(); ++i) {
    const NoticeRecord& notice = record.notices[i];
    const bool is_last = i + 1 == record.notices.size();
    if (!notice.stops || (is_last && record.steps.empty())) continue;
    const Stamp to = is_last ? record.steps.back().estimate.stamp : record.notices[i + 1].stamp;
    const auto at = std::ranges::lower_bound(record.steps, notice.stamp, {},
                                             [](const StepRecord& step) { return step.estimate.stamp; });
    if (at == record.steps.end() || at->estimate.stamp > to || to - notice.stamp < shortest) continue;
    waits.push_back({notice.stamp, to, at->estimate.map_from_base.position_m, notice.words});
  }
  return waits;
}

nlohmann::ordered_json summary_of(const RunRecord& record) {
  std::vector<double> position_m;
  std::vector<double> heading_deg;
  const std::vector<EstimateError> errors = estimate_errors(record);
  for (const EstimateError& error : errors) {
    position_m.push_back(error.position_m);
    heading_deg.push_back(degrees(std::abs(error.heading_rad)));
  }
  const auto accepted = static_cast<std::size_t>(std::ranges::count_if(record.fixes, &FixRecord::accepted));
  Json goals = Json::array();
  for (std::size_t i = 0; i < record.goals.size(); ++i)
    goals.push_back(goal_json(record.goals[i], record.score_of(i)));
  return {{"site", record.site},
          {"camera", record.camera},
          {"seed", record.seed},
          {"repeat", record.repeat},
          {"start",
           {{"x_m", record.start.position_m.x()},
            {"y_m", record.start.position_m.y()},
            {"heading_deg", degrees(record.start.yaw_rad)}}},
          {"arrived", record.arrived()},
          {"contacts", record.contacts},
          {"driven_m", driven_m(record)},
          {"time_s", record.truth.empty() ? 0.0 : seconds(record.truth.back().stamp)},
          {"duration_s", duration_s(record)},
          {"goals", goals},
          {"path_distance_m", spread_of(record.path_distances_m)},
          {"estimate_position_error_m", spread_of(position_m)},
          {"estimate_heading_error_deg", spread_of(heading_deg)},
          {"largest_position_sigma_m", optional_json(largest_sigma_m(record))},
          {"frames", record.frames},
          {"fixes", record.fixes.size()},
          {"fixes_accepted", accepted},
          {"fixes_refused", record.fixes.size() - accepted},
          {"mean_confidence", mean_confidence(record)},
          {"nees", optional_json(mean_nees(errors))},
          {"distrusted_markers", distrusted_json(record.distrusted)},
          {"waits", waits_json(waits_of(record))},
          {"notices", notices_json(record.notices)},
          {"faults", faults_json(record.faults)}};
}

}  // namespace lodestar
