#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/simulate/scenario_file.hpp"
#include "drivers/simulation/contact_judge.hpp"
#include "drivers/simulation/scoring.hpp"

namespace lodestar {

/// One drive through a scenario, as the judge of the simulated world saw it.
struct ScenarioRun {
  std::uint64_t seed = 0;
  bool success = false;  ///< arrived in time, and without an unexcused contact while moving
  double time_s = 0.0;   ///< until it arrived, or was given up
  double length_m = 0.0;
  ContactScore contacts;
  std::string reason;  ///< in words: "arrived", or what went wrong
  std::vector<TruePose> track;
};

/// Drives through the scenario until the robot rests within the goal's radius, the navigator gives up, the
/// time is over, or `goes_on`, which is asked after each step, says no. The same seed gives the same drive.
ScenarioRun run_scenario(const Scenario& scenario, std::uint64_t seed,
                         const std::function<bool()>& goes_on = {});

}  // namespace lodestar
