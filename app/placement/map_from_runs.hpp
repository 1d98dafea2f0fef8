#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "maps/occupancy_builder.hpp"

namespace lodestar {

struct MapFromRunsOptions {
  OccupancyBuilderOptions builder;
  /// Poses less sure than this are left out: an error that stays within a cell of 5 cm, at 3 m.
  double most_sigma_m = 0.02;
  double most_sigma_rad = radians(0.5);
  /// Between two poses of a run, which come 50 times a second.
  Duration most_apart = std::chrono::milliseconds(100);
  /// Scans of a robot that moved less than this share their error, and what stands before it: they count once
  /// in this time.
  double standing_m = 0.02;
  double standing_rad = radians(1.0);
  Duration standing_period = std::chrono::seconds(1);
  std::function<void(double)> progress;  ///< told the share that is done
};

/// What became of the scans of one run.
struct RunScans {
  std::filesystem::path run;
  std::string started;  ///< as run.yaml has it; empty where it does not
  std::size_t scans = 0;
  std::size_t used = 0;
  std::size_t without_pose = 0;   ///< before the first fix, or the pose was not sure enough
  std::size_t standing = 0;       ///< like the ones before
  std::size_t bytes_cut_off = 0;  ///< of the last record
};

struct MapFromRuns {
  OccupancyMap map;
  std::vector<RunScans> runs;
};

/// An occupancy map from the scans (scans.bin) and poses (steps.csv or estimate.tum) of runs, all in the
/// frame of the markers. Throws InputError, with the reason, where a run lacks either, no scan has a pose, or
/// a file is broken.
MapFromRuns map_from_runs(std::span<const std::filesystem::path> runs, const MapFromRunsOptions& options);

/// Comment lines for the map's YAML file: the runs, when they were, the scans used.
std::string provenance_comment(const MapFromRuns& built);

}  // namespace lodestar
