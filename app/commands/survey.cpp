#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/format_option.hpp"
#include "app/common/json_text.hpp"
#include "app/frames/survey_log_file.hpp"
#include "app/placement/survey_report.hpp"
#include "app/report/survey_page.hpp"
#include "app/site/site.hpp"
#include "app/site/site_folder.hpp"
#include "maps/anchors.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct SurveyArguments {
  std::vector<std::string> inputs;  ///< the site, then logs
  std::string camera;
  std::string anchors;
  std::vector<int> without;
  double max_sigma_mm = mm_per_m * SurveyOptions{}.most_sigma_m;
  std::string output;
  bool json = false;
};

struct CheckArguments {
  std::vector<std::string> inputs;  ///< the site, then logs
  std::string camera;
  std::string anchors;
  std::vector<int> without;
  std::string format = "text";
  bool apply = false;
};

const CameraModel& camera_of(const Site& site, const std::string& name) {
  const std::string& wanted = name.empty() ? site.default_camera : name;
  const auto found = site.cameras.find(wanted);
  if (found == site.cameras.end())
    throw InputError(site.folder / "site.yaml", 0, "no camera '" + wanted + "'",
                     "--camera to name one of its cameras");
  return found->second;
}

void leave_out(std::span<const int> ids, std::vector<SurveyLog>& logs) {
  for (SurveyLog& log : logs)
    for (SurveyFrame& frame : log.frames)
      std::erase_if(frame.markers, [&](const SightedMarker& marker) {
        return std::ranges::find(ids, marker.id) != ids.end();
      });
}

std::vector<SurveyLog> load_logs(std::span<const std::string> folders, const CameraModel& camera,
                                 std::span<const int> without) {
  std::vector<SurveyLog> logs;
  for (const std::string& folder : folders) {
    SurveyLog log = load_survey_log(folder, camera);
    if (std::ranges::find(logs, log.name, &SurveyLog::name) != logs.end())
      throw InputError(folder, 0, "a second log named '" + log.name + "'", "logs of different names");
    logs.push_back(std::move(log));
  }
  leave_out(without, logs);
  return logs;
}

/// Throws for an anchor that names no log, or one that is not there.
void check_anchors(const Anchors& anchors, const std::vector<SurveyLog>& logs, const fs::path& file) {
  for (const Anchor& anchor : anchors.anchors) {
    const auto* const robot = std::get_if<RobotAnchor>(&anchor.what);
    if (robot == nullptr) continue;
    if (robot->log.empty() && logs.size() > 1)
      throw InputError(file, anchor.line, "no log", fmt::format("log, as there are {}", logs.size()));
    if (!robot->log.empty() && std::ranges::find(logs, robot->log, &SurveyLog::name) == logs.end())
      throw InputError(file, anchor.line, "log '" + robot->log + "'",
                       "the name of a folder that is surveyed");
  }
}

/// None without a file.
Anchors anchors_for(const std::vector<SurveyLog>& logs, const std::string& file) {
  if (file.empty()) return {};
  Anchors anchors = load_anchors(file);
  check_anchors(anchors, logs, file);
  return anchors;
}

std::string today() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

/// The registry, and beside it where it comes from.
void write_survey(const MarkerSurvey& survey, const std::vector<SurveyLog>& logs,
                  const SurveyArguments& arguments) {
  const fs::path registry(arguments.output);
  const fs::path folder = registry.parent_path();
  write_file_atomically(folder / "survey.yaml", provenance_yaml(survey, logs, arguments.anchors, today()));
  write_file_atomically(folder / "survey-covariance.npy", covariance_npy(survey.covariance));
  write_file_atomically(folder / "survey.html", survey_html(survey, "Survey of " + arguments.output));
  save_registry(registry_of(survey), registry);
  fmt::print(stderr, "lodestar: wrote {}, and survey.html, survey.yaml and survey-covariance.npy beside it\n",
             arguments.output);
}

ExitCode survey_command(const SurveyArguments& arguments) {
  if (arguments.inputs.size() < 2) throw InputError("found no log, wanted SITE LOG...");
  const Site site = open_site(arguments.inputs.front());
  const CameraModel& camera = camera_of(site, arguments.camera);
  const std::vector<SurveyLog> logs =
      load_logs(std::span(arguments.inputs).subspan(1), camera, arguments.without);
  const Anchors anchors = anchors_for(logs, arguments.anchors);
  SurveyOptions options;
  options.most_sigma_m = arguments.max_sigma_mm / mm_per_m;
  const MarkerSurvey survey = survey_markers(logs, camera, survey_belief_of(site.robot), anchors, options);
  fmt::print("{}", arguments.json ? json_document(json_report(survey)) : text_report(survey));
  for (const std::string& line : complaints(survey)) fmt::print(stderr, "lodestar: {}\n", line);
  if (!survey.flaws.empty()) return job_failed;
  if (arguments.output.empty())
    fmt::print(stderr, "lodestar: nothing written; -o FILE writes the registry\n");
  else
    write_survey(survey, logs, arguments);
  return done;
}

/// A survey of the markers that the drive shows often enough: one on its edge is no reason to say nothing of
/// the others.
struct CheckSurvey {
  MarkerSurvey survey;
  std::vector<int> left_out;
};

CheckSurvey survey_of_often_seen(std::vector<SurveyLog> logs, const CameraModel& camera,
                                 const SurveyBelief& belief, const Anchors& anchors) {
  SurveyOptions options;
  options.most_sigma_m = 1.0;  // what a short drive does not know well is judged by its sigma
  options.least_sightings = 2;
  CheckSurvey check;
  while (true) {
    check.survey = survey_markers(logs, camera, belief, anchors, options);
    std::vector<int> rare;
    for (const SurveyRefusal& refusal : check.survey.flaws)
      if (refusal.marker) rare.push_back(*refusal.marker);
    if (rare.empty()) return check;
    leave_out(rare, logs);
    check.left_out.insert(check.left_out.end(), rare.begin(), rare.end());
  }
}

ExitCode check_command(const CheckArguments& arguments) {
  const Site site = open_site(arguments.inputs.front());
  const CameraModel& camera = camera_of(site, arguments.camera);
  const std::vector<SurveyLog> logs =
      load_logs(std::span(arguments.inputs).subspan(1), camera, arguments.without);
  const Anchors anchors = anchors_for(logs, arguments.anchors);
  const auto [survey, left_out] = survey_of_often_seen(logs, camera, survey_belief_of(site.robot), anchors);
  for (const int id : left_out)
    fmt::print(stderr, "lodestar: warning: marker {} was seen too rarely to say anything of it\n", id);
  for (const std::string& line : complaints(survey)) fmt::print(stderr, "lodestar: {}\n", line);
  if (!survey.flaws.empty()) return job_failed;
  std::optional<SurveyDifference> difference = compare(survey, site.registry, camera);
  if (!difference) {
    fmt::print(stderr,
               "lodestar: fewer than two registered markers agree with each other: survey the site anew\n");
    return job_failed;
  }
  // Seen, if rarely, or not asked for: those are not gone.
  std::erase_if(difference->proposals, [&ids = left_out, &arguments](const MarkerProposal& proposal) {
    return std::ranges::find(ids, proposal.id) != ids.end() ||
           std::ranges::find(arguments.without, proposal.id) != arguments.without.end();
  });
  if (arguments.format == "csv") fmt::print("{}", csv_report(*difference));
  if (arguments.format == "json") fmt::print("{}", json_document(json_report(*difference)));
  if (arguments.format == "text") fmt::print("{}", text_report(*difference));
  if (difference->proposals.empty()) return done;
  if (arguments.apply) {
    save_registry(with_proposals(site.registry, *difference), site.registry_file);
    fmt::print(stderr, "lodestar: {} changes written to {}\n", difference->proposals.size(),
               site.registry_file.string());
  }
  return job_failed;
}

Command add_check(CLI::App* survey) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = survey->add_subcommand(
      "check", "Markers that moved, were swapped, are new or gone, by a drive; exit 1 when there are any");
  command->add_option("inputs", arguments->inputs, "SITE LOG...: runs, or folders of images and wheels.csv")
      ->required()
      ->expected(2, -1);
  command->add_option("--camera", arguments->camera, "One of the site's cameras; default: the one it names");
  command->add_option("--anchors", arguments->anchors,
                      "What is known, as for a survey: a print's scale, say");
  command->add_option("--without", arguments->without, "IDs to leave out")
      ->check(CLI::Range(0, marker_id_count - 1));
  add_format_option(*command, arguments->format, {"text", "csv", "json"}, "text, csv or json");
  command->add_flag("--apply", arguments->apply, "Write the changes into the site's registry");
  return {command, [arguments] { return check_command(*arguments); }};
}

}  // namespace

std::vector<Command> survey_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<SurveyArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "survey",
      "Survey the markers of a site from drives; exit 1, and no file, when they do not determine it");
  command->add_option(
      "inputs", arguments->inputs,
      "SITE LOG...: a log is a run's folder, or one of images named by their stamps and wheels.csv");
  command->add_option("--camera", arguments->camera, "One of the site's cameras; default: the one it names");
  command->add_option("--anchors", arguments->anchors,
                      "What is known: places of markers or robot, distances, print");
  command->add_option("--without", arguments->without, "IDs to leave out")
      ->check(CLI::Range(0, marker_id_count - 1));
  command->add_option("--max-sigma-mm", arguments->max_sigma_mm, "Refuse when a marker is known less well")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Report as JSON");
  command->add_option("-o,--output", arguments->output,
                      "Registry to write; survey.yaml is written beside it");
  std::vector<Command> commands{add_check(command)};
  commands.push_back({command, [arguments] { return survey_command(*arguments); }});
  return commands;
}

}  // namespace lodestar
