#include "app/commands/bench_plan.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench/plan_maps.hpp"
#include "app/bench/plan_scenario.hpp"
#include "app/bench/plan_site.hpp"
#include "app/commands/bench_plan_map.hpp"
#include "app/commands/planner_options.hpp"
#include "app/common/json_text.hpp"
#include "app/site/site_folder.hpp"
#include "maps/input_error.hpp"
#include "maps/median.hpp"

namespace lodestar {
namespace {

struct BenchPlanArguments {
  std::string map;
  std::string scenario;
  std::string site;
  std::vector<std::string> planners;
  std::string generated;
  double radius_m = 0.25;
  double beside_s = 0.0;
  SiteBenchOptions bench;
  bool json = false;
};

double median_of(const std::vector<ScenarioAnswer>& answers, double ScenarioAnswer::* value) {
  std::vector<double> values;
  for (const ScenarioAnswer& answer : answers) values.push_back(answer.*value);
  return median(values);
}

double ratio(double peer, double ours) {
  return ours > 0.0 ? peer / ours : 0.0;
}

void print_row(std::size_t index, const ScenarioAnswer& answer) {
  const std::string found = answer.found ? fmt::format("{:.8f}", *answer.found) : "";
  fmt::print("{},{:.8f},{},{:.3f},{}\n", index, answer.query.expected_length, found, answer.microseconds,
             answer.expanded);
}

ExitCode bench_scenario(const BenchPlanArguments& arguments) {
  const OccupancyMap map = load_movingai_map(arguments.map);
  const std::vector<MovingAiQuery> queries = load_movingai_queries(arguments.scenario, map);
  const std::vector<ScenarioAnswer> answers = answer_scenario(map, queries, {});
  if (!arguments.json) {
    fmt::print("index,expected,found,microseconds,expanded\n");
    for (std::size_t i = 0; i < answers.size(); ++i) print_row(i, answers[i]);
  }

  const auto optimal = static_cast<std::size_t>(std::ranges::count_if(answers, &ScenarioAnswer::optimal));
  const double ours = median_of(answers, &ScenarioAnswer::microseconds);
  const double published = median_of(answers, &ScenarioAnswer::jps_plus_microseconds);
  const double astar = median_of(answers, &ScenarioAnswer::astar_microseconds);
  if (arguments.json) {
    const nlohmann::ordered_json json{{"queries", answers.size()},
                                      {"optimal", optimal},
                                      {"median_us", ours},
                                      {"jps_plus_median_us", published},
                                      {"plain_astar_median_us", astar}};
    fmt::print("{}", json_document(json));
  }
  fmt::print(
      stderr,
      "{} of {} queries optimal; median {:.2f} us; JPS+ as published {:.2f} us, {:.2f} x; plain A* with a "
      "binary heap {:.2f} us, {:.1f} x\n",
      optimal, answers.size(), ours, published, ratio(published, ours), astar, ratio(astar, ours));
  return optimal == answers.size() ? done : job_failed;
}

nlohmann::ordered_json as_json(const SiteBenchResult& result, std::uint64_t seed) {
  auto planners = nlohmann::ordered_json::array();
  for (const PlannerResult& each : result.planners) {
    planners.push_back({{"planner", to_string(each.kind)},
                        {"found", each.found},
                        {"median_us", each.microseconds},
                        {"length_ratio", each.length_ratio},
                        {"worst_length_ratio", each.worst_length_ratio},
                        {"travel_time_ratio", each.travel_time_ratio},
                        {"mean_turns", each.mean_turns}});
  }
  return {{"seed", seed},
          {"queries", result.queries},
          {"grid_search_median_us", result.grid_microseconds},
          {"planners", planners}};
}

void print_table(const SiteBenchResult& result, std::uint64_t seed) {
  fmt::print("seed {}: {} queries; 8-connected search alone, median {:.2f} us\n", seed, result.queries,
             result.grid_microseconds);
  fmt::print("planner          found  median (us)  length  worst length  travel time  turns\n");
  for (const PlannerResult& each : result.planners) {
    fmt::print("{:<15} {:>6} {:>12.1f} {:>7.4f} {:>13.4f} {:>12.4f} {:>6.2f}\n", to_string(each.kind),
               each.found, each.microseconds, each.length_ratio, each.worst_length_ratio,
               each.travel_time_ratio, each.mean_turns);
  }
  fmt::print("Medians; length and travel time as ratios to the best path found for the same query.\n");
}

ExitCode bench_planners(BenchPlanArguments arguments) {
  for (const std::string& name : arguments.planners)
    arguments.bench.kinds.push_back(planner_kind(name).value());
  if (arguments.planners.empty()) arguments.bench.kinds = all_planner_kinds();
  const SiteBenchResult result = bench_site(open_site(arguments.site), arguments.bench);
  if (arguments.json) {
    fmt::print("{}", json_document(as_json(result, arguments.bench.seed)));
  } else {
    print_table(result, arguments.bench.seed);
  }
  return done;
}

/// One planner, `fastest` unless another is given.
ExitCode bench_map(const BenchPlanArguments& arguments) {
  BenchPlanMapArguments wanted{.map = arguments.map,
                               .generated = arguments.generated,
                               .json = arguments.json,
                               .beside_s = arguments.beside_s};
  if (arguments.planners.size() > 1)
    throw InputError("bench plan: found several --planner, wanted one for a single map");
  wanted.bench.queries = arguments.bench.queries;
  wanted.bench.seed = arguments.bench.seed;
  wanted.bench.planner.radius_m = arguments.radius_m;
  wanted.bench.planner.sampling = arguments.bench.sampling;
  wanted.bench.planner.kind =
      arguments.planners.empty() ? PlannerKind::fastest : planner_kind(arguments.planners.front()).value();
  bench_on_map(wanted);
  return done;
}

}  // namespace

Command bench_plan_command(CLI::App& bench) {
  const auto arguments = std::make_shared<BenchPlanArguments>();
  CLI::App* command = bench.add_subcommand(
      "plan",
      "Planners on a MovingAI scenario, exit 1 unless all is optimal; on any map; or side by side on a site");
  CLI::Option* map = command->add_option(
      "--map", arguments->map, "MovingAI map with --scen, else map_server YAML: random queries over it");
  CLI::Option* scenario = command->add_option("--scen", arguments->scenario, "MovingAI scenario");
  CLI::Option* site =
      command->add_option("--site", arguments->site, "Site folder: random queries over its map");
  CLI::Option* generated =
      command->add_option("--generated", arguments->generated, "A map drawn from the seed instead");
  generated->check(CLI::IsMember(generated_map_names()))->excludes(map)->excludes(site)->excludes(scenario);
  map->excludes(site);
  scenario->needs(map)->excludes(site);
  command->add_option("--queries", arguments->bench.queries, "Random queries over the map")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--seed", arguments->bench.seed, "Seed of the queries, and of a generated map")
      ->capture_default_str();
  command->add_option("--radius", arguments->radius_m, "Robot radius in metres; a site has its own")
      ->check(CLI::Range(0.0, 10.0))
      ->excludes(site)
      ->excludes(scenario)
      ->capture_default_str();
  command
      ->add_option("--beside-loop", arguments->beside_s,
                   "Plan beside a control loop of 20 ms for so many seconds, and print its periods")
      ->check(CLI::Range(0.1, 86400.0))
      ->excludes(site)
      ->excludes(scenario);
  add_sampling_options(*command, arguments->bench.sampling);
  command
      ->add_option("--planner", arguments->planners, "Only these planners; default: all, on one map fastest")
      ->check(CLI::IsMember(planner_names()));
  command->add_flag("--json", arguments->json, "The table of a site, a map or a scenario as JSON");
  return {command, [arguments] {
            if (!arguments->site.empty()) return bench_planners(*arguments);
            if (!arguments->scenario.empty()) return bench_scenario(*arguments);
            if (!arguments->map.empty() || !arguments->generated.empty()) return bench_map(*arguments);
            throw InputError(
                "bench plan: found none, wanted --map and --scen, --map alone, --generated, or --site");
          }};
}

}  // namespace lodestar
