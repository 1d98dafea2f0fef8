#pragma once

#include "app/report/run_record.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

// A drive small enough to check by hand: from (1, 1) to (3, 1) and back at 1 m/s, with ground truth and an
// estimate every half second.
namespace lodestar::sample {

inline Stamp at_s(double time_s) {
  return Stamp(from_seconds(time_s));
}

/// 4 m x 2 m of free floor, its left half metre occupied, its right half metre unknown.
inline OccupancyMap floor() {
  OccupancyMap map;
  map.columns = 40;
  map.rows = 20;
  map.resolution_m = 0.1;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      map.cells.push_back(column < 5     ? OccupancyMap::occupied
                          : column >= 35 ? OccupancyMap::unknown
                                         : OccupancyMap::free);
    }
  }
  return map;
}

/// One marker centred over (2, 1.5).
inline MarkerRegistry ceiling() {
  MarkerRegistry registry;
  registry.markers.push_back(
      {.id = 77, .position_m = {1.94, 1.56, 2.6}, .yaw_rad = 0.0});  // y points down the map
  return registry;
}

inline GoalRecord goal(double from_x_m, double to_x_m, double ended_s) {
  GoalRecord record;
  record.goal = {{to_x_m, 1.0}, std::nullopt};
  record.planned.waypoints_m = {{from_x_m, 1.0}, {to_x_m, 1.0}};
  record.arrived = true;
  record.travel_time = from_seconds(2.0);
  record.ended = at_s(ended_s);
  return record;
}

/// The estimate lags the truth by 10 mm at step 1, 20 mm at step 2 and so on.
inline RunRecord run() {
  RunRecord record;
  record.site = "yard";
  record.camera = "wide";
  record.seed = 5;
  record.repeat = "lodestar replay yard --seed 5";
  record.start = {{1.0, 1.0}, 0.0};
  record.goals = {goal(1.0, 3.0, 2.0), goal(3.0, 1.0, 4.0)};
  record.scores = {2, ArrivalScore{.position_error_m = 0.004, .heading_error_rad = std::nullopt}};
  for (int i = 0; i <= 8; ++i) {
    const double time_s = 0.5 * i;
    const double x_m = i <= 4 ? 1.0 + time_s : 5.0 - time_s;
    record.truth.push_back({at_s(time_s), {{x_m, 1.0}, 0.0}});
    StepRecord step;
    step.estimate.stamp = at_s(time_s);
    step.estimate.map_from_base = {{x_m, 1.0 - 0.01 * i}, 0.0};
    step.estimate.covariance.diagonal() << 1e-4, 4e-4, 1e-6;
    record.steps.push_back(step);
  }
  for (int i = 1; i <= 20; ++i) record.path_distances_m.push_back(0.001 * i);
  record.fixes = {{at_s(1.0), {}, {77}, 0.9, true}, {at_s(2.0), {}, {77}, 0.7, false}};
  record.frames = 3;
  return record;
}

}  // namespace lodestar::sample
