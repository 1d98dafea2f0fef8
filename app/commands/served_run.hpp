#pragma once

#include <optional>
#include <string>

#include "app/commands/console_service.hpp"
#include "app/commands/driven_survey.hpp"
#include "app/commands/kept_runs.hpp"
#include "app/drive/run.hpp"
#include "app/live/operator_session.hpp"

namespace lodestar {

struct ServedRunOptions {
  ConsoleServiceOptions console;  ///< without its folders
  std::string output;             ///< the run folder; empty: one below `runs` for each drive
  std::string runs;
  std::string interface;  ///< of CAN
};

/// The console of a driving robot, and the run folders of its drives. A survey has one log for all of them.
class ServedRun {
 public:
  /// `run` is given the operator session, and what becomes of records. `survey`: null when there is none.
  ServedRun(const Site& site, const ServedRunOptions& options, RunOptions& run, const DrivenSurvey* survey);

  void keep(RunRecord record);
  /// Orders to charge are carried out by it.
  void use(Charging& charging) { session_.use(charging); }
  /// Call at the end: all drives arrived, and their run folders are whole.
  [[nodiscard]] bool succeeded() { return runs_.finish() && all_arrived_; }

 private:
  bool surveys_ = false;
  LiveLink link_;
  OperatorSession session_{link_, [this](const std::string& words) { service_.note(words); }};
  ConsoleService service_;
  KeptRuns runs_;
  bool all_arrived_ = true;
  std::optional<ConsoleThread> thread_;  // destroyed before what it serves
};

}  // namespace lodestar
