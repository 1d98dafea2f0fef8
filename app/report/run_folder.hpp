#pragma once

#include <filesystem>

#include "app/report/run_record.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Creates the folder and its parents. Throws InputError when it cannot.
void make_run_folder(const std::filesystem::path& folder);

/// Writes a run to a folder: summary.json, map.png, estimate.tum, truth.tum, steps.csv, fixes.csv, can.log,
/// report.html, and in pictures/ the kept frames, named by their stamp in seconds (12.350.jpg). The same
/// record gives the same bytes. Throws InputError when the folder cannot be written.
void write_run_folder(const std::filesystem::path& folder, const RunRecord& record, const OccupancyMap& map,
                      const MarkerRegistry& registry);

/// The same at the end of a drive, where a failed write must not fail the drive: one warning on stderr and
/// false when the folder cannot be written. Files written until then are complete.
bool leave_run_folder(const std::filesystem::path& folder, const RunRecord& record, const OccupancyMap& map,
                      const MarkerRegistry& registry);

}  // namespace lodestar
