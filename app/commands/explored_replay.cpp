#include "app/commands/explored_replay.hpp"

#include <fmt/format.h>

#include "app/commands/driven_survey.hpp"
#include "app/common/interruption.hpp"
#include "app/common/log.hpp"
#include "app/placement/exploration.hpp"
#include "app/recording/ceiling_follower.hpp"
#include "localization/detection/marker_detector.hpp"

namespace lodestar {
namespace {

/// Surveys in step with simulated time, so that the robot always knows the same at the same time: every four
/// seconds, and more rarely the more there is to solve.
class StepwiseSurvey {
 public:
  StepwiseSurvey(const Site& site, const std::string& camera, const SurveyEstimatorOptions& options)
      : follower_(site.robot, site.cameras.at(camera)), estimator_(site, camera, options) {}

  void take(const SensorInput& input) {
    constexpr double least_s = 4.0;
    constexpr double per_frame_s = 0.002;
    for (const WheelTravel& reading : input.base.travel) {
      estimator_.add(reading);
      follower_.add(reading);
    }
    for (const Frame& frame : input.frames) {
      SurveyFrame sighted{.stamp = frame.stamp, .markers = {}};
      const std::span<const DetectedMarker> markers = detector_.detect(frame.gray);
      for (const DetectedMarker& marker : markers) sighted.markers.push_back({marker.id, marker.dots});
      if (const auto motion = follower_.see(frame, markers)) estimator_.add(*motion);
      estimator_.add(std::move(sighted));
    }
    if (input.now < next_ || !estimator_.has_frames()) return;
    newest_ = estimator_.estimate();
    next_ = input.now + from_seconds(least_s + per_frame_s * static_cast<double>(newest_->frames));
  }

  [[nodiscard]] const SurveyProgress* newest() const { return newest_ ? &*newest_ : nullptr; }

 private:
  MarkerDetector detector_;
  CeilingFollower follower_;
  SurveyEstimator estimator_;
  std::optional<SurveyProgress> newest_;
  Stamp next_ = Stamp(std::chrono::seconds(2));
};

void tell(const Exploration& exploration, const SurveyProgress* newest, const ConductedDrive& drive) {
  const std::size_t markers = newest != nullptr ? newest->survey.markers.size() : 0U;
  fmt::print("{} markers surveyed in {:.0f} s and {:.0f} m, {} contacts; {} lanes given up\n", markers,
             seconds(drive.driven), drive.driven_m, drive.contacts, exploration.explorer().lanes_given_up());
  if (newest != nullptr && !newest->links.empty())
    fmt::print("weakest link: {} to {}, {:.2f} mm\n", newest->links.front().first,
               newest->links.front().second, mm_per_m * newest->links.front().sigma_m);
  tell_shortcomings(exploration, newest);
}

}  // namespace

ExitCode replay_exploring(const Site& site, SimulatedDriveOptions options,
                          const std::filesystem::path& folder) {
  Site unknown = site;
  unknown.registry = {};
  if (!options.disturbances.hung) options.disturbances.hung = site.registry;
  const PlacedStart start{.map_from_base = site.start};
  StepwiseSurvey survey(unknown, options.camera, {.start = start});
  Exploration exploration(unknown, options.camera, start);
  DrivenSurvey log(folder, unknown, options.camera, {.can_wait = true, .shows_progress = false});
  options.on_input = [&](const SensorInput& input) {
    survey.take(input);
    log.take(input);
  };
  const Interruption interruption;
  options.goes_on = [] { return !Interruption::asked(); };
  options.goals.clear();
  auto state = ExplorationState::under_way;
  const ConductedDrive drive =
      simulate_conducted_drive(unknown, options, [&](const MissionStep& step, Mission& mission) {
        state = exploration.conduct(step, mission, survey.newest());
        return state == ExplorationState::under_way;
      });
  tell(exploration, survey.newest(), drive);
  const bool is_recorded = log.finish();
  return state == ExplorationState::done && drive.contacts == 0 && is_recorded ? done : job_failed;
}

}  // namespace lodestar
