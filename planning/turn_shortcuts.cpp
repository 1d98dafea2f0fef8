#include "planning/turn_shortcuts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace lodestar {
namespace {

constexpr std::size_t ray_count = 180;
constexpr std::size_t most_fans = 6;  // of a path, as each costs 0.1 to 0.3 ms

/// A direction and its heading; all are the same for every fan.
struct Ray {
  Vec2 direction = Vec2::Zero();
  double heading_rad = 0.0;
};

const std::array<Ray, ray_count>& rays() {
  static const std::array<Ray, ray_count> all = [] {
    std::array<Ray, ray_count> made;
    for (std::size_t k = 0; k < ray_count; ++k) {
      const double heading_rad = wrap_angle(2.0 * std::numbers::pi / ray_count * static_cast<double>(k));
      made[k] = {Vec2(std::cos(heading_rad), std::sin(heading_rad)), heading_rad};
    }
    return made;
  }();
  return all;
}

/// How far each ray from a point is clear. Zeros: none was sent out.
struct RayFan {
  std::array<double, ray_count> length_cells{};
  double longest_cells = 0.0;
};

RayFan fan_around(const CollisionChecker& space, const Vec2& point) {
  RayFan fan;
  for (std::size_t k = 0; k < ray_count; ++k)
    fan.length_cells[k] = space.clear_length(point, rays()[k].direction);
  fan.longest_cells = *std::ranges::max_element(fan.length_cells);
  return fan;
}

/// A ray of the fan at the far end, which a ray from the near end can meet.
struct Facing {
  std::size_t ray = 0;
  double aside = 0.0;  ///< cross product of the way between the ends with its direction
};

/// One turn in place of all between two points of the path.
struct Shortcut {
  double saved = 0.0;
  std::size_t from = 0;
  std::size_t to = 0;
  Vec2 turn = Vec2::Zero();
};

/// The part of the path that a shortcut may replace.
struct Part {
  std::size_t from = 0;
  std::size_t to = 0;
  Vec2 between = Vec2::Zero();
  EndHeadings headings;
  double cost = 0.0;
};

class Shortcuts {
 public:
  Shortcuts(std::vector<Vec2> points, const EndHeadings& headings, const CollisionChecker& space,
            const PathCost& cost)
      : points_(std::move(points)), headings_(headings), space_(space), cost_(cost) {}

  CountedPath run() {
    send_out_fans();
    for (Shortcut best = find(); best.saved > 0.0; best = find()) take(best);
    return {std::move(points_), work_};
  }

 private:
  /// From start and goal, and some of the turns between.
  void send_out_fans() {
    fans_.resize(points_.size());
    const std::size_t last = points_.size() - 1;
    const std::size_t count = std::min(points_.size(), most_fans);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = i * last / (count - 1);
      fans_[at] = fan_around(space_, points_[at]);
    }
    work_ += count * ray_count * work_of_ray;
  }

  void take(const Shortcut& at) {
    const auto first = static_cast<std::ptrdiff_t>(at.from) + 1;
    const auto last = static_cast<std::ptrdiff_t>(at.to);
    points_.erase(points_.begin() + first, points_.begin() + last);
    points_.insert(points_.begin() + first, at.turn);
    fans_.erase(fans_.begin() + first, fans_.begin() + last);
    fans_.insert(fans_.begin() + first, fan_around(space_, at.turn));
    work_ += ray_count * work_of_ray;
  }

  Shortcut find() {
    Shortcut best;
    for (std::size_t from = 0; from + 2 < points_.size(); ++from) {
      for (std::size_t to = from + 2; to < points_.size(); ++to) {
        if (fans_[from].longest_cells > 0.0 && fans_[to].longest_cells > 0.0) look_at(part(from, to), best);
      }
    }
    return best;
  }

  [[nodiscard]] Part part(std::size_t from, std::size_t to) const {
    Part part{.from = from,
              .to = to,
              .between = points_[to] - points_[from],
              .headings = headings_of_part(points_, from, to, headings_)};
    part.cost = cost_.path(std::span(points_).subspan(from, to - from + 1), part.headings);
    return part;
  }

  void look_at(const Part& part, Shortcut& best) {
    const RayFan& near = fans_[part.from];
    const double straight_cells = part.between.norm();
    const double limit = part.cost * (1.0 - worthwhile_saving) - best.saved;
    if (cost_.at_least(straight_cells) >= limit) return;
    for (const bool to_the_left : {true, false}) {
      face(part, to_the_left, straight_cells - near.longest_cells);
      for (std::size_t k = 0; k < ray_count; ++k) {
        const bool is_left = cross(part.between, rays()[k].direction) > 0.0;
        const bool is_long = near.length_cells[k] + fans_[part.to].longest_cells >= straight_cells;
        if (is_left == to_the_left && is_long) meet(part, k, best);
      }
    }
  }

  /// Lists the rays at the far end that lead to one side and may be long enough.
  void face(const Part& part, bool to_the_left, double least_cells) {
    facing_.clear();
    for (std::size_t k = 0; k < ray_count; ++k) {
      const double aside = cross(part.between, rays()[k].direction);
      if ((aside > 0.0) == to_the_left && fans_[part.to].length_cells[k] >= least_cells)
        facing_.push_back({k, aside});
    }
  }

  /// Looks where a ray from the near end meets those from the far end.
  void meet(const Part& part, std::size_t ray, Shortcut& best) const {
    const Vec2& direction = rays()[ray].direction;
    const double aside = cross(part.between, direction);
    for (const Facing& facing : facing_) {
      const double parallel = cross(direction, rays()[facing.ray].direction);
      const double to_cells = aside / parallel;
      if (!(to_cells > 0.0) || to_cells > fans_[part.to].length_cells[facing.ray]) continue;
      const double from_cells = facing.aside / parallel;
      if (from_cells > fans_[part.from].length_cells[ray]) continue;
      const double saved = part.cost - cost_with(part, ray, facing.ray, from_cells, to_cells);
      if (saved <= std::max(best.saved, worthwhile_saving * part.cost)) continue;
      const Vec2 turn = points_[part.from] + from_cells * direction;
      // Rounding may lay a leg beside its ray.
      if (space_.along(points_[part.from], turn) && space_.along(turn, points_[part.to]))
        best = {saved, part.from, part.to, turn};
    }
  }

  [[nodiscard]] double cost_with(const Part& part, std::size_t from_ray, std::size_t to_ray,
                                 double from_cells, double to_cells) const {
    const double out_rad = rays()[from_ray].heading_rad;
    const double in_rad = rays()[(to_ray + ray_count / 2) % ray_count].heading_rad;
    double cost = cost_.at_least(from_cells) + cost_.at_least(to_cells) + cost_.turn(out_rad, in_rad);
    if (part.headings.start_rad) cost += cost_.turn(*part.headings.start_rad, out_rad);
    if (part.headings.goal_rad) cost += cost_.turn(in_rad, *part.headings.goal_rad);
    return cost;
  }

  std::vector<Vec2> points_;
  std::vector<RayFan> fans_;  ///< by point
  EndHeadings headings_;
  const CollisionChecker& space_;
  const PathCost& cost_;
  std::vector<Facing> facing_;
  std::size_t work_ = 0;
};

}  // namespace

CountedPath with_shortcuts(std::vector<Vec2> points, const EndHeadings& headings,
                           const CollisionChecker& space, const PathCost& cost) {
  if (points.size() < 3) return {std::move(points), 0};
  return Shortcuts(std::move(points), headings, space, cost).run();
}

}  // namespace lodestar
