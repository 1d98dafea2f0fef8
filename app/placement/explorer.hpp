#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "app/placement/survey_estimator.hpp"
#include "planning/coverage_lanes.hpp"

namespace lodestar {

struct ExplorerOptions {
  double margin_m = 0.15;           ///< beyond the robot's radius: its place on the map is not yet known well
  double ceiling_m = 2.5;           ///< assumed for the lanes' spacing; a higher ceiling shows more
  double near_m = 0.5;              ///< of a goal that the robot could not see it has arrived at
  int most_failures = 2;            ///< of a lane, before it is given up
  std::size_t most_crossings = 12;  ///< of weak links, at the end
};

/// Where to drive next, so that every marker over the free floor is seen and tied to its neighbours: lanes
/// there and across, the nearest first, then across the weakest links until all meet the target.
class Explorer {
 public:
  Explorer(const Site& site, const std::string& camera, const PlacedStart& start,
           const ExplorerOptions& options = {});

  /// Nothing when there is nothing left to drive, or nothing that can be reached.
  std::optional<Goal> next(const Vec2& here_m, const SurveyProgress* progress);

  /// The outcome of the last goal; `here_m`: where the robot believes it is now. Within near_m of the goal a
  /// lane counts as driven: no marker need be in view at its end.
  void reached();
  void failed(const std::optional<Vec2>& here_m);

  [[nodiscard]] std::size_t lanes_left() const { return lanes_.size(); }
  [[nodiscard]] std::size_t lanes_given_up() const { return given_up_; }

 private:
  struct Task {
    Lane lane;
    int failures = 0;
    bool is_on_lane = false;  ///< at its beginning, and drives to its end
  };

  std::optional<Task> nearest_lane(const Vec2& here_m);
  std::optional<Task> crossing(const SurveyProgress& progress);
  [[nodiscard]] Goal goal_of(const Task& task) const;

  ExplorerOptions options_;
  std::vector<Task> lanes_;
  std::optional<Task> now_;
  std::set<std::pair<int, int>> crossed_;
  std::size_t given_up_ = 0;
};

}  // namespace lodestar
