#include "app/commands/driven_survey.hpp"

#include <fmt/format.h>

#include "app/common/log.hpp"
#include "app/report/run_folder.hpp"

namespace lodestar {
namespace {

std::string in_words(const SurveyProgress& progress) {
  const MarkerSurvey& survey = progress.survey;
  if (!survey.flaws.empty())
    return fmt::format("{}: {}", to_string(survey.flaws.front().flaw), survey.flaws.front().found);
  double worst_m = 0.0;
  for (const RegisteredMarker& marker : survey.markers)
    worst_m = std::max(worst_m, marker.sigma.value_or(MarkerSigma{}).position_m);
  std::string words =
      fmt::format("{} markers, the worst known to {:.1f} mm", survey.markers.size(), mm_per_m * worst_m);
  if (!progress.links.empty() && progress.links.front().sigma_m > progress.target_sigma_m)
    words += fmt::format("; drive across between {} and {} next", progress.links.front().first,
                         progress.links.front().second);
  return words;
}

/// Says in the log how the survey stands, whenever the words change.
std::function<void(const SurveyProgress&)> to_log() {
  return [said = std::string()](const SurveyProgress& progress) mutable {
    std::string words = in_words(progress);
    if (words == said) return;
    log_info("survey: " + words);
    said = std::move(words);
  };
}

std::filesystem::path made(std::filesystem::path folder) {
  make_run_folder(folder);
  return folder;
}

}  // namespace

DrivenSurvey::DrivenSurvey(std::filesystem::path folder, const Site& site, const std::string& camera,
                           const DrivenSurveyOptions& options)
    : folder_(made(std::move(folder))),
      site_(site),
      live_(options.shows_progress
                ? std::make_unique<LiveSurvey>(
                      site, camera, LiveSurveyOptions{.estimate = {.start = options.start}, .tell = to_log()})
                : nullptr),
      log_(folder_, site.robot, site.cameras.at(camera),
           {.can_wait = options.can_wait,
            .tell = log_warning,
            .disk = {},
            .on_frame =
                [this](const SurveyFrame& frame) {
                  if (live_) live_->add(frame);
                },
            .on_travel =
                [this](const WheelTravel& reading) {
                  if (live_) live_->add(reading);
                },
            .on_ceiling =
                [this](const VisualOdometryIncrement& motion) {
                  if (live_) live_->add(motion);
                }}) {}

void tell_next_step(const Site& site, const std::filesystem::path& log) {
  fmt::print(stderr, "lodestar: surveyed; the registry: lodestar survey {} {} -o markers.yaml\n",
             site.folder.string(), log.string());
}

bool DrivenSurvey::finish() {
  const std::string loss = log_.finish();
  if (!loss.empty()) log_warning("the survey's log is not whole: " + loss);
  tell_next_step(site_, folder_);
  return loss.empty();
}

void tell_shortcomings(const Exploration& exploration, const SurveyProgress* newest) {
  for (const std::string& line : exploration.shortcomings(newest)) fmt::print(stderr, "lodestar: {}\n", line);
  if (!exploration.last_failure().empty())
    fmt::print(stderr, "lodestar: the last goal that was not reached: {}\n", exploration.last_failure());
}

}  // namespace lodestar
