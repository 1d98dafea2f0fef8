#pragma once

#include <filesystem>
#include <vector>

#include "maps/occupancy_map.hpp"

// The benchmark files of Sturtevant (2012), "Benchmarks for grid-based pathfinding": maps of letters, and
// lists of queries with the length of the shortest 8-connected path that cuts no corners.
namespace lodestar {

/// A `.map` file. Row 0 is the file's first line: y points down in the file and rows count upwards here, so
/// the map is mirrored, which changes no distance. Cells of `.`, `G` and `S` are free, those of `@`, `O`, `T`
/// and `W` occupied; the resolution is 1 m. Throws InputError with file and line.
OccupancyMap load_movingai_map(const std::filesystem::path& file);

/// One line of a `.scen` file.
struct MovingAiQuery {
  Cell start;
  Cell goal;
  double expected_length = 0.0;  ///< in cells, as printed in the file
  double rounding = 0.0;  ///< half a unit of its last printed digit; the sixth, where zeros were dropped
};

/// The queries of a `.scen` file (version 1) for this map, in order; the map's name in the file is not
/// compared, its size is. Throws InputError with file and line: start or goal that is outside or not
/// drivable, ...
std::vector<MovingAiQuery> load_movingai_queries(const std::filesystem::path& file, const OccupancyMap& map);

}  // namespace lodestar
