#pragma once

#include <string>

#include "app/navigation/mission.hpp"
#include "app/placement/explorer.hpp"

namespace lodestar {

/// How far an exploration has come.
enum class ExplorationState {
  under_way,
  done,        ///< every lane was driven or given up, and no weak link is left to cross
  robot_lost,  ///< a stop that a person must end
};

/// Drives a robot over a site whose markers nobody has measured: it goes by those that it has surveyed so
/// far, with their sigmas, comes back when it grows too uncertain (as on any drive), and goes on where
/// markers are missing. Decides between the steps; the mission drives.
class Exploration {
 public:
  Exploration(const Site& site, const std::string& camera, const PlacedStart& start,
              const ExplorerOptions& options = {});

  /// After each step. `newest`: the survey so far, null before the first estimate.
  ExplorationState conduct(const MissionStep& step, Mission& mission, const SurveyProgress* newest);

  [[nodiscard]] const Explorer& explorer() const { return explorer_; }
  /// Why the last goal failed, in words; empty when none has.
  [[nodiscard]] const std::string& last_failure() const { return last_failure_; }

 private:
  void use(const SurveyProgress& newest, Mission& mission);

  PlacedStart start_;
  Explorer explorer_;
  bool is_placed_ = false;
  std::uint64_t used_ = 0;
  std::string last_failure_;
};

}  // namespace lodestar
