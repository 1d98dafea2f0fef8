#pragma once

#include <filesystem>

#include "app/report/run_record.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// Creates the folder and its parents. Throws InputError when it cannot.
void make_run_folder(const std::filesystem::path& folder);

/// Leaves what is known at the end of a run in a folder: summary.json, map.png, estimate.tum, truth.tum,
/// steps.csv, fixes.csv, report.html, proposals.csv where the robot distrusts a marker, and in pictures/ the
/// kept frames, named by their stamp in seconds (12.350.jpg). The same record gives the same bytes. Throws
/// InputError when the folder cannot be written; what was written until then is whole.
void write_run_folder(const std::filesystem::path& folder, const RunRecord& record, const OccupancyMap& map,
                      const MarkerRegistry& registry, const Places& places = {});

}  // namespace lodestar
