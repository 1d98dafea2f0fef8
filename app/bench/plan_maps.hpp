#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/occupancy_map.hpp"

// Maps of the kind that SLAM makes, drawn from a seed, to measure planners on.
namespace lodestar {

/// Square offices: rooms with doors of 0.95 to 1.2 m on corridors of 2 m, desks, the whole rotated by 3
/// degrees. Walls have a jitter of 1.5 cm and are of uneven thickness, as measured by a scanner.
OccupancyMap ragged_offices(double size_m, double resolution_m, std::uint64_t seed);

/// A square room with this many single occupied cells at random places, like the legs of chairs.
OccupancyMap scattered_posts(double size_m, double resolution_m, int posts, std::uint64_t seed);

/// A map by name, as the command line has them; nothing for an unknown name.
std::optional<OccupancyMap> generated_map(std::string_view name, std::uint64_t seed);
std::vector<std::string> generated_map_names();

}  // namespace lodestar
