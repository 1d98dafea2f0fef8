#pragma once

#include <string>

#include "app/common/command.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "app/simulate/simulated_drives.hpp"

namespace lodestar {

struct RepeatedReplayOptions {
  int runs = 1;  ///< with the drive's seed and the following ones
  bool quiet = false;
  bool json = false;
  std::string output;  ///< folder for runs.json; empty: none
};

/// The same drive with one seed after the other, as a table. Exit 1 unless all of them succeeded.
ExitCode replay_many(const Site& site, SimulatedDriveOptions options, const RepeatedReplayOptions& wanted);

/// All goals were reached, and nothing was touched.
bool succeeded(const RunSummary& run);

}  // namespace lodestar
