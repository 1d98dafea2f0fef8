#include "app/bench/plan_queries.hpp"

#include "maps/random.hpp"

namespace lodestar {
namespace {

/// A uniformly random point of the map, not only cell centres.
Vec2 random_place(const OccupancyMap& map, Random& random) {
  const Vec2 in_grid(random.uniform(0.0, map.columns), random.uniform(0.0, map.rows));
  return map.map_from_grid * Vec2(in_grid * map.resolution_m);
}

}  // namespace

std::vector<PlanQuery> random_queries(const CollisionChecker& space, int count, double least_distance_m,
                                      std::uint64_t seed) {
  constexpr int most_tries = 100000;
  const OccupancyMap& map = space.map();
  Random random(seed);
  std::vector<PlanQuery> queries;
  for (int i = 0; i < most_tries && static_cast<int>(queries.size()) < count; ++i) {
    const PlanQuery query{random_place(map, random), random_place(map, random)};
    const Cell start = map.cell_at(query.start_m);
    const Cell goal = map.cell_at(query.goal_m);
    if (!space.at(start) || !space.at(goal) || space.region(start) != space.region(goal)) continue;
    const Vec2 start_in_grid = inverse(map.map_from_grid) * query.start_m / map.resolution_m;
    const Vec2 goal_in_grid = inverse(map.map_from_grid) * query.goal_m / map.resolution_m;
    if (!space.along(start_in_grid, start_in_grid) || !space.along(goal_in_grid, goal_in_grid)) continue;
    if ((query.goal_m - query.start_m).norm() >= least_distance_m) queries.push_back(query);
  }
  return queries;
}

}  // namespace lodestar
