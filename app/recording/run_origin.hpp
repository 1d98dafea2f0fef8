#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What a drive began with, as its run folder's run.yaml has it.
struct RunOrigin {
  std::string started;  ///< UTC in ISO 8601, by the machine's clock
  std::string program;  ///< its version
  std::string site;
  std::optional<std::uint64_t> seed;  ///< of a simulated world
  /// Of a real one: what UTC, counted from 1970, was ahead of the robot's clock when the drive began.
  std::optional<Duration> clock_offset = std::nullopt;
};

/// In a run folder: the map and the registry that the robot drove on, for whoever looks at the run when the
/// site has changed.
inline constexpr const char* map_of_run = "site/map.yaml";
inline constexpr const char* markers_of_run = "site/markers.yaml";

/// Leaves run.yaml, which is the one file that tells two runs of the same seed apart, and map and registry.
/// Throws InputError when the folder cannot be written.
void write_run_origin(const std::filesystem::path& folder, const RunOrigin& origin, const OccupancyMap& map,
                      const MarkerRegistry& registry);

/// Nothing where the folder has no run.yaml, as of runs before there was one. Throws InputError for one that
/// cannot be read.
std::optional<RunOrigin> read_run_origin(const std::filesystem::path& folder);

}  // namespace lodestar
