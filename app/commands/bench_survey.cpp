#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench/survey_bench.hpp"
#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/common/parallel.hpp"

namespace lodestar {
namespace {

struct SurveyBenchArguments {
  int seeds = 3;
  int spoiled = 0;
  std::uint64_t seed = 1;
  std::string only;
  bool exact_print = false;
  bool json = false;
};

/// Over all seeds of a scenario.
struct SurveyFigures {
  std::string name;
  int seeds = 0;
  int refused = 0;
  std::string why;
  double rms_m = 0.0;
  double worst_m = 0.0;
  double shape_m = 0.0;
  double bound_m = 0.0;
  double nees_per_freedom = 0.0;
  double solve_s = 0.0;  ///< the longest
  double covariance_s = 0.0;
  double mount_off_m = 0.0;  ///< root mean square
  double mount_off_rad = 0.0;
  double fix_by_survey_m = 0.0;
  double fix_by_truth_m = 0.0;
  int fixes = 0;
  int lost_fixes = 0;
  SurveyTrial last;
  std::vector<std::string> broken;  ///< limits, in words

  [[nodiscard]] double over_bound() const { return bound_m > 0.0 ? rms_m / bound_m : 0.0; }
  [[nodiscard]] double over_true_fix() const {
    return fix_by_truth_m > 0.0 ? fix_by_survey_m / fix_by_truth_m : 0.0;
  }
  [[nodiscard]] double lost() const {
    return static_cast<double>(lost_fixes) / std::max(1, fixes + lost_fixes);
  }
};

/// Ratios of few seeds are chance: half of a print's errors are one number a seed.
constexpr int seeds_for_ratios = 20;

std::vector<std::string> broken_limits(const SurveyFigures& figures, const SurveyLimits& limits) {
  std::vector<std::string> broken;
  const auto at_most = [&](const char* what, double found, double limit, double unit, const char* name) {
    if (found > limit)
      broken.push_back(fmt::format("{} {:.3g}{}, at most {:.3g}", what, unit * found, name, unit * limit));
  };
  if (figures.refused > 0) broken.push_back(fmt::format("{} refused", figures.refused));
  if (figures.refused == figures.seeds) return broken;
  at_most("RMS", figures.rms_m, limits.most_rms_m, mm_per_m, " mm");
  at_most("shape", figures.shape_m, limits.most_shape_m, mm_per_m, " mm");
  at_most("mount off by", figures.mount_off_m, limits.most_mount_m, mm_per_m, " mm");
  at_most("mount turned by", degrees(figures.mount_off_rad), degrees(limits.most_mount_rad), 1.0, " deg");
  at_most("lost fixes", figures.lost(), limits.most_lost_fixes, 100.0, " %");
  at_most("solve", figures.solve_s, limits.most_solve_s, 1.0, " s");
  at_most("covariance", figures.covariance_s, limits.most_covariance_s, 1.0, " s");
  if (figures.seeds < seeds_for_ratios) return broken;
  at_most("RMS over bound", figures.over_bound(), limits.most_over_bound, 1.0, "");
  at_most("NEES", figures.nees_per_freedom, limits.most_nees, 1.0, "");
  at_most("fix error over that by the true registry", figures.over_true_fix(), limits.most_over_true_fix, 1.0,
          "");
  if (figures.nees_per_freedom < limits.least_nees)
    broken.push_back(
        fmt::format("NEES {:.2f}, at least {:.2f}", figures.nees_per_freedom, limits.least_nees));
  return broken;
}

SurveyFigures figures_of(const SurveyScenario& scenario, const SurveyBenchArguments& arguments) {
  std::vector<SurveyTrial> trials(static_cast<std::size_t>(arguments.seeds));
  in_parallel(arguments.seeds, [&](int i) {
    trials[static_cast<std::size_t>(i)] =
        try_survey(scenario, arguments.seed + static_cast<std::uint64_t>(i), arguments.exact_print);
  });
  SurveyFigures figures{.name = scenario.name, .seeds = arguments.seeds};
  double nees = 0.0;
  double freedom = 0.0;
  int good = 0;
  for (const SurveyTrial& trial : trials) {
    if (trial.refused) {
      ++figures.refused;
      figures.why = trial.why;
      continue;
    }
    ++good;
    figures.rms_m += square(trial.errors.rms_m);
    figures.shape_m += square(trial.errors.shape_m);
    figures.bound_m += square(trial.bound_m);
    figures.mount_off_m += square(trial.mount_off_m);
    figures.mount_off_rad += square(trial.mount_off_rad);
    figures.fixes += trial.fixes.fixes;
    figures.lost_fixes += trial.fixes.lost;
    figures.worst_m = std::max(figures.worst_m, trial.errors.worst_m);
    nees += trial.errors.nees;
    freedom += trial.errors.freedom;
    figures.fix_by_survey_m += square(trial.fixes.by_survey_m);
    figures.fix_by_truth_m += square(trial.fixes.by_truth_m);
    figures.solve_s = std::max(figures.solve_s, trial.solve_s);
    figures.covariance_s = std::max(figures.covariance_s, trial.covariance_s);
    figures.last = trial;
  }
  for (double* const squares : {&figures.rms_m, &figures.shape_m, &figures.bound_m, &figures.mount_off_m,
                                &figures.mount_off_rad, &figures.fix_by_survey_m, &figures.fix_by_truth_m})
    *squares = std::sqrt(*squares / std::max(1, good));
  figures.nees_per_freedom = freedom > 0.0 ? nees / freedom : 0.0;
  figures.broken = broken_limits(figures, scenario.limits);
  return figures;
}

nlohmann::ordered_json as_json(const SurveyFigures& figures) {
  return {{"scenario", figures.name},
          {"seeds", figures.seeds},
          {"refused", figures.refused},
          {"markers", figures.last.markers},
          {"length_m", figures.last.length_m},
          {"keyframes", figures.last.keyframes},
          {"rms_m", figures.rms_m},
          {"worst_m", figures.worst_m},
          {"shape_m", figures.shape_m},
          {"bound_m", figures.bound_m},
          {"nees_per_freedom", figures.nees_per_freedom},
          {"fix_by_survey_m", figures.fix_by_survey_m},
          {"fix_by_truth_m", figures.fix_by_truth_m},
          {"fixes", figures.fixes},
          {"lost_fixes", figures.lost_fixes},
          {"mount_off_m", figures.mount_off_m},
          {"mount_off_deg", degrees(figures.mount_off_rad)},
          {"solve_s", figures.solve_s},
          {"covariance_s", figures.covariance_s},
          {"broken_limits", figures.broken}};
}

void print_head() {
  fmt::print(
      "{:34} {:>5} {:>7} {:>7} {:>6} {:>7} {:>8} {:>8} {:>8} {:>7} {:>5} {:>5} {:>6} {:>8} {:>9} {:>7} "
      "{:>5}\n",
      "tour", "seeds", "refused", "markers", "m", "RMS mm", "worst mm", "shape mm", "bound mm", "x bound",
      "NEES", "x fix", "lost %", "mount mm", "mount deg", "solve s", "cov s");
}

void print_line(const SurveyFigures& figures) {
  constexpr double percent = 100.0;
  fmt::print(
      "{:34} {:5} {:7} {:7} {:6.0f} {:7.2f} {:8.2f} {:8.2f} {:8.2f} {:7.2f} {:5.2f} {:5.2f} {:6.2f} {:8.2f} "
      "{:9.3f} {:7.1f} {:5.1f}{}\n",
      figures.name, figures.seeds, figures.refused, figures.last.markers, figures.last.length_m,
      mm_per_m * figures.rms_m, mm_per_m * figures.worst_m, mm_per_m * figures.shape_m,
      mm_per_m * figures.bound_m, figures.over_bound(), figures.nees_per_freedom, figures.over_true_fix(),
      percent * figures.lost(), mm_per_m * figures.mount_off_m, degrees(figures.mount_off_rad),
      figures.solve_s, figures.covariance_s, figures.why.empty() ? "" : "  " + figures.why);
}

/// A seed has its own kind, so that one log can be repeated alone.
Spoiling kind_of(std::uint64_t seed) {
  const std::vector<Spoiling> kinds = all_spoilings();
  return kinds[seed % kinds.size()];
}

/// The exit code is that of a promise kept: no registry written that is silently wrong.
ExitCode spoiled_survey(const SurveyBenchArguments& arguments) {
  const std::vector<Spoiling> kinds = all_spoilings();
  std::vector<SpoiledTrial> trials(static_cast<std::size_t>(arguments.spoiled));
  in_parallel(arguments.spoiled, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const std::uint64_t seed = arguments.seed + at;
    trials[at] = try_spoiled(kind_of(seed), seed);
  });
  struct Counts {
    int logs = 0;
    int refused = 0;
    int said = 0;
    int silent = 0;
    std::map<std::string, int> words;
  };
  std::vector<Counts> counts(kinds.size());
  int silently_wrong = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::uint64_t seed = arguments.seed + i;
    Counts& of_kind = counts[static_cast<std::size_t>(kind_of(seed))];
    ++of_kind.logs;
    of_kind.refused += trials[i].refused ? 1 : 0;
    if (trials[i].refused) ++of_kind.words[trials[i].why];
    if (!trials[i].is_wrong()) continue;
    const bool is_silent = trials[i].is_silently_wrong();
    ++(is_silent ? of_kind.silent : of_kind.said);
    silently_wrong += is_silent ? 1 : 0;
    fmt::print(stderr, "wrong{}: seed {} ({}), squared normalized error {:.1f} for {} numbers\n",
               is_silent ? ", silently" : "", seed, to_string(kind_of(seed)), trials[i].nees,
               trials[i].freedom);
  }
  auto rows = nlohmann::ordered_json::array();
  if (!arguments.json)
    fmt::print("{:14} {:>5} {:>8} {:>17} {:>15}  refused for\n", "spoiled", "logs", "refused",
               "wrong and said so", "silently wrong");
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    rows.push_back({{"spoiled", to_string(kinds[k])},
                    {"logs", counts[k].logs},
                    {"refused", counts[k].refused},
                    {"wrong_and_said_so", counts[k].said},
                    {"silently_wrong", counts[k].silent},
                    {"words", counts[k].words}});
    if (arguments.json) continue;
    std::string words;
    for (const auto& [word, count] : counts[k].words) words += fmt::format(" {} {}", count, word);
    fmt::print("{:14} {:5} {:8} {:17} {:15} {}\n", to_string(kinds[k]), counts[k].logs, counts[k].refused,
               counts[k].said, counts[k].silent, words);
  }
  if (arguments.json) fmt::print("{}", json_document(rows));
  return silently_wrong == 0 ? done : job_failed;
}

ExitCode bench_survey(const SurveyBenchArguments& arguments) {
  fmt::print(stderr, "seed {}\n", arguments.seed);
  if (arguments.spoiled > 0) return spoiled_survey(arguments);
  auto rows = nlohmann::ordered_json::array();
  if (!arguments.json) print_head();
  bool is_kept = true;
  for (const SurveyScenario& scenario : survey_scenarios()) {
    if (scenario.name.find(arguments.only) == std::string::npos) continue;
    const SurveyFigures figures = figures_of(scenario, arguments);
    rows.push_back(as_json(figures));
    if (!arguments.json) print_line(figures);
    for (const std::string& limit : figures.broken)
      fmt::print(stderr, "lodestar: {}: {}\n", figures.name, limit);
    is_kept = is_kept && figures.broken.empty();
  }
  if (arguments.json) fmt::print("{}", json_document(rows));
  return is_kept ? done : job_failed;
}

}  // namespace

Command bench_survey_command(CLI::App& bench) {
  const auto arguments = std::make_shared<SurveyBenchArguments>();
  CLI::App* command = bench.add_subcommand(
      "survey", "Errors, consistency and time of surveys by driving; exit 1 when a tour breaks its limits");
  command->add_option("--seeds", arguments->seeds, "Worlds for each tour")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "First seed")->capture_default_str();
  command->add_option("--only", arguments->only, "Tours whose names contain this");
  command
      ->add_option(
          "--spoiled", arguments->spoiled,
          "Instead: so many logs with something wrong in them; exit 1 if one gives a wrong registry silently")
      ->check(CLI::Range(0, 1000000));
  command->add_flag("--exact-print", arguments->exact_print,
                    "The print's scale is 1, not drawn with the 1e-4 to which it is known");
  command->add_flag("--json", arguments->json, "Results as JSON");
  return {command, [arguments] { return bench_survey(*arguments); }};
}

}  // namespace lodestar
