#pragma once

#include <filesystem>
#include <memory>

#include "app/placement/exploration.hpp"
#include "app/placement/live_survey.hpp"
#include "app/recording/sighting_log.hpp"

namespace lodestar {

struct DrivenSurveyOptions {
  bool can_wait = false;             ///< a simulated drive loses no frame
  bool shows_progress = true;        ///< estimates the registry while the robot drives
  std::optional<PlacedStart> start;  ///< where the robot stands at the beginning
};

/// The log of a survey: dots.csv and wheels.csv of all that the robot sees, whoever drives it, from the start
/// of the program to its end.
class DrivenSurvey {
 public:
  /// Makes the folder. Throws InputError when it cannot.
  DrivenSurvey(std::filesystem::path folder, const Site& site, const std::string& camera,
               const DrivenSurveyOptions& options);

  /// Holds nobody up, but where the drive can wait.
  void take(const SensorInput& input) { log_.take(input); }

  /// Null without progress.
  [[nodiscard]] const LiveSurvey* live() const { return live_.get(); }

  /// Waits for the disk, and tells what to do next. False when a part of the log is missing.
  [[nodiscard]] bool finish();

 private:
  std::filesystem::path folder_;
  const Site& site_;
  std::unique_ptr<LiveSurvey> live_;
  SightingLog log_;  ///< last: its thread tells the others
};

/// Says which command makes a registry of the log.
void tell_next_step(const Site& site, const std::filesystem::path& log);

/// Says what an exploration has left undone, and which markers it knows too little of.
void tell_shortcomings(const Exploration& exploration, const SurveyProgress* newest);

}  // namespace lodestar
