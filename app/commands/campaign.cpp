#include "app/campaign/campaign.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "app/campaign/campaign_report.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/recorded_run.hpp"
#include "app/common/interruption.hpp"
#include "app/common/json_text.hpp"
#include "app/common/progress.hpp"
#include "app/site/site_folder.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct CampaignArguments {
  std::string site;
  std::uint64_t first = 1;
  int missions = 100;
  std::optional<std::uint64_t> mission;
  bool resume = false;
  CampaignWorld world;
  bool quiet = false;
  std::string output = "runs/campaign";
};

void print_failure(const MissionOutcome& outcome) {
  std::string faults;
  for (const std::string& fault : outcome.faults) faults += (faults.empty() ? "" : ", ") + fault;
  fmt::print("{}: {} ({}); repeat with: {}\n", outcome.mission, outcome.what_happened(),
             faults.empty() ? "no fault" : faults, repeat_command(outcome));
}

ExitCode verdict(const std::vector<MissionOutcome>& outcomes) {
  return std::ranges::any_of(outcomes, &MissionOutcome::has_failed) ? job_failed : done;
}

ExitCode run_one(const Site& robot_and_cameras, std::uint64_t number, const CampaignWorld& world,
                 const fs::path& output) {
  CampaignMission mission = mission_of(robot_and_cameras, campaign_ids(), number, world);
  RecordedRun recorded(output / fmt::format("mission-{}", number), mission.site, mission.replay.camera,
                       {.seed = mission.replay.seed, .can_wait = true});
  mission.replay.watch = recorded.watcher();
  RunRecord record = simulate_drive(mission.site, mission.replay);
  const MissionOutcome outcome = outcome_of(number, record, mission.site, world);
  record.repeat = repeat_command(outcome);
  const RunFolderEnd end = recorded.finish(record);
  if (!end.loss.empty()) throw InputError(end.loss);
  fmt::print("{}", json_document(as_json(outcome)));
  fmt::print(stderr, "run folder: {}\n", recorded.folder().string());
  return verdict({outcome});
}

ExitCode campaign_command(const CampaignArguments& arguments) {
  const Site site = open_site(arguments.site);
  if (arguments.mission) return run_one(site, *arguments.mission, arguments.world, arguments.output);
  const Interruption interruption;
  std::vector<MissionOutcome> outcomes;
  {
    Progress progress("campaign", arguments.quiet);
    outcomes = run_campaign(site,
                            {.first = arguments.first,
                             .missions = arguments.missions,
                             .resume = arguments.resume,
                             .world = arguments.world,
                             .goes_on = [] { return !Interruption::asked(); }},
                            arguments.output, [&progress](double share) { progress.show(share); });
  }
  const nlohmann::ordered_json report = campaign_json(outcomes);
  write_file_atomically(fs::path(arguments.output) / "campaign.json", json_document(report));
  write_file_atomically(fs::path(arguments.output) / "campaign.html", campaign_html(outcomes));
  for (const MissionOutcome& outcome : outcomes)
    if (outcome.has_failed() || outcome.is_excused()) print_failure(outcome);
  const auto& all = report["all"];
  fmt::print("{} missions: {} arrivals, {} safe stops, {} with contacts, {} silently wrong; report: {}\n",
             all["missions"].get<int>(), all["arrivals"].get<int>(), all["safe_stops"].get<int>(),
             all["contacts"].get<int>(), all["silently_wrong"].get<int>(),
             (fs::path(arguments.output) / "campaign.html").string());
  if (const int excused = all["excused"].get<int>(); excused > 0)
    fmt::print("{} with an excused contact, whose cause nothing on board could show\n", excused);
  if (all.contains("people"))
    fmt::print("contacts with people: {} while moving, {} excused, {} at rest; at {:.2f} m/s at most\n",
               all["people"]["moving"].get<int>(), all["people"]["excused"].get<int>(),
               all["people"]["at_rest"].get<int>(), all["people"]["greatest_mps"].get<double>());
  if (outcomes.size() < static_cast<std::size_t>(arguments.missions)) {
    fmt::print(stderr, "lodestar: interrupted after {} of {} missions; --resume continues\n", outcomes.size(),
               arguments.missions);
    return job_failed;
  }
  return verdict(outcomes);
}

}  // namespace

std::vector<Command> campaign_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<CampaignArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "campaign", "Missions through random buildings with faults; exit 1 on a contact or a wrong arrival");
  command->add_option("missions", arguments->missions, "Number of missions")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--site", arguments->site, "Site folder for robot and cameras; default: the lab");
  command->add_option("--first", arguments->first, "Number of the first mission")->capture_default_str();
  command->add_option("--mission", arguments->mission, "Run this mission only, and write its run folder");
  command->add_flag("--people", arguments->world.has_people,
                    "One to six people walk about in each building, boxes and chairs stand or are pushed in "
                    "the way, doors slide shut, and the robot has a scanner");
  command->add_flag("!--no-faults", arguments->world.has_faults,
                    "Nothing fails, and all markers hang where the registry says");
  command->add_flag("--resume", arguments->resume, "Continue an interrupted campaign");
  command->add_flag("--quiet", arguments->quiet, "No progress bar");
  command->add_option("-o,--output", arguments->output, "Folder of the report")->capture_default_str();
  return {{command, [arguments] { return campaign_command(*arguments); }}};
}

}  // namespace lodestar
