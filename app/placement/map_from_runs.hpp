#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/placement/placed_scans.hpp"
#include "maps/occupancy_builder.hpp"

namespace lodestar {

struct MapFromRunsOptions {
  OccupancyBuilderOptions builder;
  PlacedScansOptions scans;
  std::function<void(double)> progress;  ///< told the share that is done
};

/// What became of the scans of one run.
struct RunScans {
  std::filesystem::path run;
  std::string started;  ///< as run.yaml has it; empty where it does not
  ScanCounts counts;
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
