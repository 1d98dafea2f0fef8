#pragma once

#include <filesystem>
#include <vector>

#include "app/site/site.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "drivers/simulation/overhang.hpp"
#include "drivers/simulation/simulated_scanner.hpp"

namespace lodestar {

/// A world given as data, and the drive through it: docs/scenario.md.
struct Scenario {
  Site site;  ///< its map, robot, start, one goal, and the markers that hang
  double goal_radius_m = 0.0;
  double time_limit_s = 0.0;
  SimulatedScannerOptions scanner;
  std::vector<MovingDisc> discs;
  std::vector<Overhang> overhangs;
  bool is_placed_at_start = false;  ///< a person says where the robot starts: no markers hang
};

/// Reads a `format: lodestar-scenario` file. `lab` gives the camera, and the robot where the file names none.
/// Throws InputError with file and line.
Scenario load_scenario(const std::filesystem::path& file, const Site& lab);

}  // namespace lodestar
