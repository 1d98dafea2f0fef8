#include "app/commands/repeated_replay.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fmt/core.h>

#include "app/commands/run_summary_json.hpp"
#include "app/common/interruption.hpp"
#include "app/common/json_text.hpp"
#include "app/common/progress.hpp"
#include "app/report/run_folder.hpp"
#include "app/simulate/run_table.hpp"
#include "maps/atomic_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// CPU time used so far, of all cores.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

bool succeeded(const RunSummary& run) {
  const bool hit_people = run.people && run.people->moving > 0;
  return run.arrivals == run.goals && run.contacts == 0 && !hit_people;
}

ExitCode replay_many(const Site& site, SimulatedDriveOptions options, const RepeatedReplayOptions& wanted) {
  if (!wanted.output.empty()) make_run_folder(wanted.output);
  const Interruption interruption;
  options.goes_on = [] { return !Interruption::asked(); };
  const double begun_s = cpu_seconds();
  std::vector<RunSummary> runs;
  {
    Progress progress("replay", wanted.quiet);
    runs = simulate_drives(site, options, wanted.runs,
                           [&](int finished) { progress.show(static_cast<double>(finished) / wanted.runs); });
  }
  nlohmann::ordered_json report = nlohmann::ordered_json::array();
  for (const RunSummary& run : runs) report.push_back(as_json(run));
  if (wanted.json) {
    fmt::print("{}", json_document(report));
  } else {
    print_run_table(runs, cpu_seconds() - begun_s);
  }
  if (!wanted.output.empty()) {
    write_file_atomically(fs::path(wanted.output) / "runs.json", json_document(report));
  }
  if (runs.size() < static_cast<std::size_t>(wanted.runs)) {
    fmt::print(stderr, "lodestar: interrupted after {} of {} runs\n", runs.size(), wanted.runs);
    return job_failed;
  }
  return std::ranges::all_of(runs, succeeded) ? done : job_failed;
}

}  // namespace lodestar
