#pragma once

#include <string>

#include "app/navigation/mission.hpp"
#include "app/placement/explorer.hpp"

namespace lodestar {

/// How far an exploration has come.
enum class ExplorationState {
  under_way,
  done,        ///< every lane was driven, and every marker is tied to its neighbours as well as wanted
  incomplete,  ///< nothing is left to try, and something is missing: Exploration::shortcomings()
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
  /// What this survey lacks, in words, one a line; empty when it is complete.
  [[nodiscard]] std::vector<std::string> shortcomings(const SurveyProgress* newest) const;
  /// Why the last goal failed, in words; empty when none has.
  [[nodiscard]] const std::string& last_failure() const { return last_failure_; }

 private:
  void use(const SurveyProgress& newest, Mission& mission);
  ExplorationState when_nothing_is_left(const SurveyProgress* newest);

  PlacedStart start_;
  Explorer explorer_;
  bool is_placed_ = false;
  std::uint64_t used_ = 0;
  std::optional<std::uint64_t> at_the_end_;  ///< the estimate when the last lane had been driven
  std::string last_failure_;
};

}  // namespace lodestar
