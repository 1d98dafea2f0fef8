#include "app/bench_plan_scenario.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/median.hpp"
#include "planning/grid_search.hpp"
#include "planning/jump_search.hpp"

namespace lodestar {
namespace {

template <typename Work>
double microseconds_of(const Work& work) {
  const auto before = std::chrono::steady_clock::now();
  work();
  const auto after = std::chrono::steady_clock::now();
  return std::chrono::duration<double, std::micro>(after - before).count();
}

}  // namespace

bool ScenarioAnswer::optimal() const {
  constexpr double exact = 1e-3;  // cells
  return found && std::abs(*found - query.expected_length) <= std::max(exact, query.rounding);
}

std::vector<ScenarioAnswer> answer_scenario(const OccupancyMap& map,
                                            const std::vector<MovingAiQuery>& queries,
                                            const ScenarioOptions& options) {
  const ClearSpace space(map, 0.0);
  const JumpTable jumps(space);
  JumpSearch search(jumps);
  const CellCosts even(map.cells.size(), 1.0F);
  GridSearch astar(space, even);

  std::vector<ScenarioAnswer> answers;
  for (const MovingAiQuery& query : queries) {
    ScenarioAnswer answer{.query = query};
    std::vector<double> times;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      times.push_back(microseconds_of([&] {
        const std::optional<JumpPath> path = search.find(query.start, query.goal);
        if (!path) return;
        answer.found = path->steps.length_cells();
        answer.expanded = path->expanded;
      }));
    }
    answer.microseconds = median(times);
    answer.astar_microseconds = microseconds_of([&] { (void)astar.find(query.start, query.goal); });
    answers.push_back(answer);
  }
  return answers;
}

}  // namespace lodestar
