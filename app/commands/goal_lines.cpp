#include "app/commands/goal_lines.hpp"

#include <fmt/core.h>

#include "app/report/run_statistics.hpp"

namespace lodestar {
namespace {

std::string end_of(const GoalRecord& goal, const std::optional<ArrivalScore>& score, double driven_m) {
  if (!goal.arrived) return "not reached: " + (goal.failure.empty() ? "never started" : goal.failure);
  std::string words = fmt::format("reached after {:.1f} s", seconds(goal.travel_time));
  if (!score) return words;
  words += fmt::format(" and {:.2f} m, {:.1f} mm", driven_m, 1000.0 * score->position_error_m);
  if (score->heading_error_rad) words += fmt::format(" and {:.2f} deg", degrees(*score->heading_error_rad));
  return words + " off by the truth";
}

}  // namespace

void print_goals(const RunRecord& record) {
  const std::vector<std::vector<TruePose>> parts = parts_of_track(record);
  for (std::size_t i = 0; i < record.goals.size(); ++i) {
    const Vec2& at = record.goals[i].goal.position_m;
    const double driven_m = i < parts.size() ? length_m(parts[i]) : 0.0;
    fmt::print("({:.2f}, {:.2f}): {}\n", at.x(), at.y(),
               end_of(record.goals[i], record.score_of(i), driven_m));
  }
}

}  // namespace lodestar
