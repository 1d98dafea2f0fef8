#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "app/placement/visibility.hpp"
#include "app/report/run_record.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// The experiment's figure (the paper's Fig. 12): map, zones and places, markers, planned curve, driven
/// track, start and end, scale bar, legend.
cv::Mat draw_experiment(const RunRecord& record, const OccupancyMap& map, const MarkerRegistry& registry,
                        const Places& places = {});

/// Map, markers and one planned path; start and goal alone when the path is empty. With `visibility`, cells
/// are coloured by how many markers are seen from there.
cv::Mat draw_plan(const OccupancyMap& map, const MarkerRegistry& registry, const Vec2& start_m,
                  const Vec2& goal_m, const Path& path, const Visibility* visibility = nullptr);

}  // namespace lodestar
