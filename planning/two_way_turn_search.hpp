#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planning/path_cost.hpp"
#include "planning/place_screen.hpp"
#include "planning/turn_point_choice.hpp"
#include "planning/turn_search_limits.hpp"

namespace lodestar {

struct TurnPath {
  std::vector<Vec2> points;  ///< start, turns, goal in grid coordinates
  double cost = 0.0;
  std::size_t expanded = 0;  ///< labels expanded
  std::size_t work = 0;      ///< as TurnSearchLimits count it
  /// Other paths, hardly dearer, by other ways or turns: refined, one of them may be the cheapest.
  std::vector<std::vector<Vec2>> others;
};

/// A cheap path of straight clear legs over a choice of many turn points, in bounded time and memory. First
/// backwards from the goal: Dijkstra with one label a point, its cheapest path to the goal with the turns on
/// it. Then forwards from the start with arrival headings: A* whose heuristic is that cost and the turn into
/// it. So each label taken from the open list completes a path, and the search can end at any of them: when
/// its work is used up, or when no label promises less. Memory is kept between searches.
class TwoWayTurnSearch {
 public:
  /// Space and turn points must outlive it.
  TwoWayTurnSearch(const CollisionChecker& space, std::span<const TurnPoint> turn_points,
                   const TurnSearchLimits& limits);

  /// `known` is a clear path from start to goal. Its points are turn points too, and it is the answer when no
  /// cheaper one is found. Each round chooses others.
  TurnPath find(std::span<const Vec2> known, const EndHeadings& headings, const PathCost& cost, int round);

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  static constexpr std::uint32_t goal = 0;
  static constexpr std::uint32_t start = 1;
  enum class Sight : std::uint8_t { unknown, perhaps, clear, blocked };

  /// Start, goal, or a turn point.
  struct Place {
    Vec2 position = Vec2::Zero();
    std::optional<Vec2> corner;
    double to_start_cells = 0.0;  ///< over tiles
    double to_goal_cells = 0.0;
    double least_from_start = 0.0;
    double least_to_goal = 0.0;
    std::uint32_t next = none;  ///< on its cheapest path to the goal; none: not reached
    double cost_to_goal = 0.0;
    double heading_on_rad = 0.0;  ///< of the leg to `next`
    std::uint32_t newest_label = none;
  };
  struct Label {
    double cost = 0.0;
    double heading_rad = 0.0;
    std::uint32_t place = 0;
    std::uint32_t parent = none;
    std::uint32_t older_label = none;  ///< of the same place
  };
  struct Open {
    double total = 0.0;
    double cost = 0.0;  ///< forwards: of the way here; backwards: of the way on
    double heading_rad = 0.0;
    std::uint32_t place = 0;
    std::uint32_t from = 0;  ///< forwards: the parent label; backwards: the next place
    bool looked_at = false;  ///< the leg has been checked clear, and `cost` is its true cost
  };
  struct Later;

  void gather_places(std::span<const Vec2> known, int round);
  void add_place(const TurnPlace& at);
  [[nodiscard]] bool may_see(const Place& from, const Place& to, double length_cells) const;
  [[nodiscard]] bool is_taut(const Place& at, const Vec2& from, const Vec2& to) const;
  [[nodiscard]] Sight& sight_between(std::uint32_t a, std::uint32_t b) {
    return sights_[std::min(a, b) * places_.size() + std::max(a, b)];
  }
  bool may_be_clear(std::uint32_t from, std::uint32_t to);
  bool sees(std::uint32_t from, std::uint32_t to);
  std::optional<double> extra_cost(std::uint32_t from, std::uint32_t to);
  bool is_settled(Open& label, std::uint32_t from, std::uint32_t to);
  void push(const Open& open);
  Open pop();

  void search_backwards();
  void expand_backwards(std::uint32_t place);
  [[nodiscard]] std::optional<TurnAround> turn_around(std::uint32_t place) const;
  void search_forwards();
  void expand_forwards(std::uint32_t label);
  [[nodiscard]] double turn_at(std::uint32_t place, double arrival_rad) const;
  [[nodiscard]] bool is_dominated(const Open& open) const;
  [[nodiscard]] std::vector<Vec2> points_over(std::uint32_t label) const;
  [[nodiscard]] TurnPath best_paths();

  const CollisionChecker& space_;
  TurnSearchLimits limits_;
  TurnPointChoice choice_;
  const PathCost* cost_ = nullptr;  ///< of the present search, as all members below
  EndHeadings headings_;
  double limit_ = 0.0;
  std::size_t work_ = 0;
  std::size_t expanded_ = 0;
  std::vector<Open> complete_;  ///< labels with a path to the goal: their total, `from` is the label
  std::vector<Place> places_;
  PlaceScreen screen_;         ///< of the places not reached yet
  std::vector<Sight> sights_;  ///< between places
  std::vector<Label> labels_;
  std::vector<Open> open_;
};

}  // namespace lodestar
