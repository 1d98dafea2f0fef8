#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planning/corners.hpp"
#include "planning/path_cost.hpp"
#include "planning/turn_search_limits.hpp"
#include "planning/two_way_turn_search.hpp"

namespace lodestar {

/// The shortest, or nearly the fastest, path of straight clear legs that turns at turn points only: A* on
/// their visibility graph. A state is a turn point with the arrival heading, on which the next turn's cost
/// depends; it is dominated when another path and a turn on the spot reach it more cheaply. Only legs taken
/// from the open list are checked for a line of sight (lazy A*, Cohen, Phillips and Likhachev 2014). When its
/// work is used up, the best path found so far is the answer. Where turns count and cells do not, and where
/// too many turn points may lie on a cheaper path, TwoWayTurnSearch searches instead. Memory is kept between
/// searches.
class VisibilityGraphSearch {
 public:
  /// The space must outlive it.
  VisibilityGraphSearch(const CollisionChecker& space, std::vector<TurnPoint> turn_points,
                        const TurnSearchLimits& limits = {});

  /// `known` is a clear path from start to goal. Its cost is the upper bound, its points are turn points too,
  /// and it is the answer when no cheaper one is found. Rounds but the first search both ways.
  TurnPath find(std::span<const Vec2> known, const EndHeadings& headings, const PathCost& cost,
                int round = 0);

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  /// A turn point that can lie on a path cheaper than the known one.
  struct Candidate {
    Vec2 position = Vec2::Zero();
    Vec2 corner = Vec2::Zero();
    double least_to_goal = 0.0;
    double heading_to_goal_rad = 0.0;
    std::uint32_t turn_point = none;  ///< none: a point of the known path
    std::uint32_t newest_label = none;
  };
  /// A leg that may be clear, at its least cost.
  struct Leg {
    double cost = 0.0;
    double heading_rad = 0.0;  ///< 0 when turns do not count
    std::uint32_t to = 0;
  };
  /// A path to a candidate.
  struct Label {
    double cost = 0.0;
    double heading_rad = 0.0;
    std::uint32_t candidate = 0;
    std::uint32_t parent = none;
    std::uint32_t older_label = none;  ///< of the same candidate
  };
  struct Open {
    double total = 0.0;
    double cost = 0.0;  ///< up to the candidate
    double heading_rad = 0.0;
    std::uint32_t candidate = 0;
    std::uint32_t parent = 0;
    bool looked_at = false;  ///< the leg has been checked clear, and `cost` is its true cost
  };
  /// The point being expanded, with its arrival leg.
  struct Expanded {
    Vec2 position = Vec2::Zero();
    Vec2 arrival = Vec2::Zero();  ///< the leg to it
    Vec2 to_corner = Vec2::Zero();
    double corner_side = 0.0;  ///< cross product of arrival and to_corner
    std::uint32_t turn_point = none;
    std::uint32_t candidate = none;
  };
  struct Later;
  enum class Sight : std::uint8_t { unknown, clear, blocked };

  [[nodiscard]] const Vec2& position_of(const Label& label) const {
    return label.candidate == none ? start_ : candidates_[label.candidate].position;
  }
  /// The start comes after all candidates.
  [[nodiscard]] std::size_t place_of(std::uint32_t candidate) const {
    return candidate == none ? candidates_.size() : candidate;
  }
  bool gather_candidates(std::span<const Vec2> known);
  [[nodiscard]] TurnPath search(std::span<const Vec2> known);
  void add_candidate(const Vec2& position, std::uint32_t turn_point);
  [[nodiscard]] const std::vector<Leg>& legs_from(std::uint32_t candidate);
  void expand(std::uint32_t label);
  void consider(std::uint32_t label, const Leg& leg);
  void push(const Open& open);
  [[nodiscard]] bool turns_around_its_corner(const Vec2& way) const;
  [[nodiscard]] Sight& sight(std::uint32_t from, std::uint32_t to);
  [[nodiscard]] bool is_dominated(const Open& open) const;
  [[nodiscard]] double least_rest(const Candidate& candidate, double heading_rad) const;
  bool goes_on(Open& open);
  bool sees(std::uint32_t from, std::uint32_t to);
  [[nodiscard]] std::optional<TurnPath> best_waiting();
  [[nodiscard]] std::vector<Vec2> points_to(std::uint32_t label) const;

  const CollisionChecker& space_;
  std::vector<TurnPoint> turn_points_;
  TurnSearchLimits limits_;
  TwoWayTurnSearch two_way_;
  const PathCost* cost_ = nullptr;  ///< of the present search, as all members below
  EndHeadings headings_;
  Vec2 start_ = Vec2::Zero();
  Vec2 goal_ = Vec2::Zero();
  double limit_ = 0.0;
  std::size_t work_ = 0;
  std::vector<Candidate> candidates_;   ///< the goal first
  std::vector<std::vector<Leg>> legs_;  ///< by place; empty: not listed yet
  std::vector<Sight> sights_;           ///< between places
  std::vector<Label> labels_;
  std::vector<Open> open_;
  Expanded from_;
};

}  // namespace lodestar
