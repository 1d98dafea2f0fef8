#include "app/simulate/scenario.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands/commands.hpp"
#include "app/common/interruption.hpp"
#include "app/common/json_text.hpp"
#include "app/common/parallel.hpp"
#include "app/common/picture_file.hpp"
#include "app/report/run_folder.hpp"
#include "app/simulate/scenario_figure.hpp"
#include "app/site/site_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct ScenarioArguments {
  std::string file;
  int seeds = 1;
  std::uint64_t first = 1;
  bool json = false;
  std::string output;
};

nlohmann::ordered_json as_json(const ScenarioRun& run) {
  const std::optional<double>& clearance_m = run.contacts.least_clearance_m;
  return {{"seed", run.seed},
          {"success", run.success},
          {"time_s", run.time_s},
          {"length_m", run.length_m},
          {"contacts_moving", run.contacts.moving},
          {"contacts_excused", run.contacts.excused},
          {"contacts_at_rest", run.contacts.at_rest},
          {"greatest_contact_mps", run.contacts.greatest_contact_mps},
          {"least_clearance_m",
           clearance_m ? nlohmann::ordered_json(*clearance_m) : nlohmann::ordered_json(nullptr)},
          {"reason", run.reason}};
}

void print_heading() {
  fmt::print("  seed  success  time (s)  length (m)  moving  excused  at rest  (m/s)  clearance (m)\n");
}

void print_row(const ScenarioRun& run) {
  const std::optional<double>& clearance_m = run.contacts.least_clearance_m;
  fmt::print("{:>6} {:>8} {:>9.1f} {:>11.2f} {:>7} {:>8} {:>8} {:>6.2f} {:>14}  {}\n", run.seed,
             run.success ? "yes" : "no", run.time_s, run.length_m, run.contacts.moving, run.contacts.excused,
             run.contacts.at_rest, run.contacts.greatest_contact_mps,
             clearance_m ? fmt::format("{:.3f}", *clearance_m) : "-", run.reason);
}

/// Prints each run as soon as it and all before it are there.
class InOrder {
 public:
  InOrder(int count, bool json) : runs_(static_cast<std::size_t>(count)), json_(json) {}

  void take(int i, ScenarioRun run) {
    const std::lock_guard lock(mutex_);
    run.track.clear();
    runs_[static_cast<std::size_t>(i)] = std::move(run);
    for (; next_ < runs_.size() && runs_[next_]; ++next_) print(*runs_[next_]);
  }

  [[nodiscard]] bool all_succeeded() const {
    return std::ranges::all_of(runs_, [](const auto& run) { return run && run->success; });
  }

 private:
  void print(const ScenarioRun& run) const {
    if (!json_) return print_row(run);
    fmt::print("{}\n", json_text(as_json(run)));
    std::fflush(stdout);
  }

  std::mutex mutex_;
  std::vector<std::optional<ScenarioRun>> runs_;
  std::size_t next_ = 0;
  bool json_;
};

ExitCode scenario_command(const ScenarioArguments& arguments) {
  const Scenario scenario = load_scenario(arguments.file, open_site(""));
  for (const std::string& warning : scenario.site.map.warnings)
    fmt::print(stderr, "lodestar: warning: {}\n", warning);
  const fs::path output = arguments.output;
  if (!output.empty()) make_run_folder(output);
  const Interruption interruption;
  const auto goes_on = [] { return !Interruption::asked(); };
  InOrder in_order(arguments.seeds, arguments.json);
  if (!arguments.json) print_heading();
  in_parallel(arguments.seeds, [&](int i) {
    if (!goes_on()) return;
    const ScenarioRun run = run_scenario(scenario, arguments.first + static_cast<std::uint64_t>(i), goes_on);
    if (!goes_on()) return;  // perhaps in the middle of this one
    if (!output.empty())
      write_png(output / fmt::format("scenario-{}.png", run.seed), draw_scenario(scenario, run));
    in_order.take(i, run);
  });
  if (!goes_on()) fmt::print(stderr, "lodestar: interrupted; the runs before are printed\n");
  return in_order.all_succeeded() ? done : job_failed;
}

}  // namespace

std::vector<Command> scenario_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<ScenarioArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "scenario",
      "Drive through a world given as data: a map, moving discs, a start and a goal; exit 1 "
      "unless every run succeeds");
  command->add_option("file", arguments->file, "The scenario, a YAML file as docs/scenario.md describes it")
      ->required();
  command->add_option("--seeds", arguments->seeds, "Number of runs, with this seed and the following ones")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--seed", arguments->first, "Seed of the first run; the same seed gives the same drive")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "One JSON object a run, each on a line");
  command->add_option("-o,--output", arguments->output,
                      "Folder for a picture of each run: map, discs' ways and driven track");
  return {{command, [arguments] { return scenario_command(*arguments); }}};
}

}  // namespace lodestar
