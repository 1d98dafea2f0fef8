#include "app/commands/bench_plan.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <memory>

#include "app/bench_plan_scenario.hpp"
#include "app/median.hpp"

namespace lodestar {
namespace {

struct BenchPlanArguments {
  std::string map;
  std::string scenario;
};

double median_of(const std::vector<ScenarioAnswer>& answers, double ScenarioAnswer::* value) {
  std::vector<double> values;
  for (const ScenarioAnswer& answer : answers) values.push_back(answer.*value);
  return median(values);
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
  fmt::print("index,expected,found,microseconds,expanded\n");
  for (std::size_t i = 0; i < answers.size(); ++i) print_row(i, answers[i]);

  const auto optimal = static_cast<std::size_t>(std::ranges::count_if(answers, &ScenarioAnswer::optimal));
  const double ours = median_of(answers, &ScenarioAnswer::microseconds);
  const double astar = median_of(answers, &ScenarioAnswer::astar_microseconds);
  fmt::print(stderr,
             "{} of {} queries optimal; median {:.2f} us, plain A* with a binary heap {:.2f} us, {:.1f} x\n",
             optimal, answers.size(), ours, astar, ours > 0.0 ? astar / ours : 0.0);
  return optimal == answers.size() ? done : job_failed;
}

}  // namespace

Command bench_plan_command(CLI::App& bench) {
  const auto arguments = std::make_shared<BenchPlanArguments>();
  CLI::App* command = bench.add_subcommand(
      "plan", "Planning times: a MovingAI scenario's queries; exit 1 unless all are optimal");
  command->add_option("--map", arguments->map, "MovingAI map")->required();
  command->add_option("--scen", arguments->scenario, "MovingAI scenario")->required();
  return {command, [arguments] { return bench_scenario(*arguments); }};
}

}  // namespace lodestar
