#include "app/bench/plan_scenario.hpp"

#include <algorithm>
#include <cmath>

#include "app/bench/jps_plus.hpp"
#include "app/common/stopwatch.hpp"
#include "maps/median.hpp"
#include "planning/grid_search.hpp"
#include "planning/jump_search.hpp"

namespace lodestar {
namespace {

/// Asks all queries in turn: repeating the same one at once would run on warm caches.
template <typename Ask>
void time_each(const std::vector<MovingAiQuery>& queries, std::vector<std::vector<double>>& times,
               const Ask& ask) {
  for (std::size_t i = 0; i < queries.size(); ++i)
    times[i].push_back(microseconds_of([&] { ask(queries[i], i); }));
}

}  // namespace

bool ScenarioAnswer::optimal() const {
  constexpr double exact = 1e-3;  // cells
  return found && std::abs(*found - query.expected_length) <= std::max(exact, query.rounding);
}

std::vector<ScenarioAnswer> answer_scenario(const OccupancyMap& map,
                                            const std::vector<MovingAiQuery>& queries,
                                            const ScenarioOptions& options) {
  const CollisionChecker space(map, 0.0);
  const JumpTable jumps(space);
  JumpSearch search(jumps);
  JpsPlus jps_plus(jumps);
  const CellCosts even(map.cells.size(), 1.0F);
  GridSearch astar(space, even);

  std::vector<ScenarioAnswer> answers;
  for (const MovingAiQuery& query : queries) answers.push_back({.query = query});
  std::vector<std::vector<double>> times(queries.size());
  std::vector<std::vector<double>> jps_plus_times(queries.size());
  for (int pass = 0; pass < options.repeats; ++pass) {
    time_each(queries, times, [&](const MovingAiQuery& query, std::size_t i) {
      const std::optional<JumpPath> path = search.find(query.start, query.goal);
      if (!path) return;
      answers[i].found = path->steps.length_cells();
      answers[i].expanded = path->expanded;
    });
    time_each(queries, jps_plus_times,
              [&](const MovingAiQuery& query, std::size_t) { (void)jps_plus.find(query.start, query.goal); });
  }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].microseconds = median(times[i]);
    answers[i].jps_plus_microseconds = median(jps_plus_times[i]);
    answers[i].astar_microseconds =
        microseconds_of([&] { (void)astar.find(queries[i].start, queries[i].goal); });
  }
  return answers;
}

}  // namespace lodestar
