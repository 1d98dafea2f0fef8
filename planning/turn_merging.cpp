#include "planning/turn_merging.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lodestar {
namespace {

/// Rays from a point, to both sides of a direction. Each is checked no farther than needed.
class Fan {
 public:
  Fan(const CollisionChecker& space, const Vec2& apex, const Vec2& towards) : space_(space), apex_(apex) {
    const double middle_rad = heading_between(apex, towards);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const double heading_rad = wrap_angle(middle_rad + radians(offsets_deg[i]));
      rays_[i].heading_rad = heading_rad;
      rays_[i].direction = Vec2(std::cos(heading_rad), std::sin(heading_rad));
    }
  }

  /// Denser near the present leg, as most obstacles leave little room. Twice as many cost twice the time and
  /// saved hardly a turn more on ragged offices.
  static constexpr std::array offsets_deg{0.0, 1.0, -1.0, 3.0, -3.0, 7.0, -7.0, 14.0, -14.0};

  [[nodiscard]] const Vec2& apex() const { return apex_; }
  [[nodiscard]] const Vec2& direction(std::size_t ray) const { return rays_[ray].direction; }
  [[nodiscard]] Vec2 point(std::size_t ray, double length) const {
    return apex_ + length * rays_[ray].direction;
  }
  [[nodiscard]] double heading_rad(std::size_t ray) const { return rays_[ray].heading_rad; }

  bool is_clear(std::size_t ray, double length) {
    Ray& at = rays_[ray];
    if (length <= at.clear_to) return true;
    if (length >= at.blocked_at) return false;
    const bool clear = space_.along(apex_, point(ray, length));
    (clear ? at.clear_to : at.blocked_at) = length;
    return clear;
  }

 private:
  struct Ray {
    Vec2 direction = Vec2::Zero();
    double heading_rad = 0.0;
    double clear_to = 0.0;
    double blocked_at = std::numeric_limits<double>::infinity();
  };

  const CollisionChecker& space_;
  Vec2 apex_;
  std::array<Ray, offsets_deg.size()> rays_;
};

/// Where two rays meet.
struct Meeting {
  double cost = 0.0;  ///< at least, of the part of the path that it replaces
  std::size_t ray_from = 0;
  std::size_t ray_to = 0;
  double length_from = 0.0;
  double length_to = 0.0;
};

class TurnMerging {
 public:
  TurnMerging(std::vector<Vec2> points, const EndHeadings& headings, const CollisionChecker& space,
              const PathCost& cost)
      : points_(std::move(points)), headings_(headings), space_(space), cost_(cost) {}

  CountedPath run() {
    for (std::size_t from = 0; from + 3 < points_.size();) {
      if (!merge(from, from + 4) && !merge(from, from + 3)) ++from;
    }
    return {std::move(points_), work_};
  }

 private:
  /// Replaces the turns between two points of the path by one.
  bool merge(std::size_t from, std::size_t to) {
    if (to >= points_.size()) return false;
    const double limit = cost_around({&points_[from], to - from + 1}, from, to) * (1.0 - worthwhile_saving);
    Fan fan_from(space_, points_[from], points_[from + 1]);
    Fan fan_to(space_, points_[to], points_[to - 1]);
    work_ += Fan::offsets_deg.size() * Fan::offsets_deg.size();
    for (const Meeting& at : meetings(fan_from, fan_to, from, to, limit)) {
      work_ += work_of_check(at.length_from) + work_of_check(at.length_to);
      if (!fan_from.is_clear(at.ray_from, at.length_from) || !fan_to.is_clear(at.ray_to, at.length_to))
        continue;
      const std::array three{points_[from], fan_from.point(at.ray_from, at.length_from), points_[to]};
      // Rounding may lay the second leg beside its ray.
      if (!space_.along(three[1], three[2]) || cost_around(three, from, to) >= limit) continue;
      points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(from) + 2,
                    points_.begin() + static_cast<std::ptrdiff_t>(to));
      points_[from + 1] = three[1];
      return true;
    }
    return false;
  }

  /// Cost of a part from one point of the path to another, with the turns at both.
  [[nodiscard]] double cost_around(std::span<const Vec2> part, std::size_t from, std::size_t to) const {
    return cost_.path(part, headings_of_part(points_, from, to, headings_));
  }

  /// Those that may cost less than the limit, cheapest first.
  const std::vector<Meeting>& meetings(const Fan& fan_from, const Fan& fan_to, std::size_t from,
                                       std::size_t to, double limit) {
    const EndHeadings ends = headings_of_part(points_, from, to, headings_);
    meetings_.clear();
    for (std::size_t i = 0; i < Fan::offsets_deg.size(); ++i) {
      for (std::size_t k = 0; k < Fan::offsets_deg.size(); ++k) {
        std::optional<Meeting> at = meeting(fan_from, i, fan_to, k);
        if (!at || at->cost >= limit) continue;
        const double in_rad = wrap_angle(fan_to.heading_rad(k) + std::numbers::pi);
        at->cost += cost_.turn(fan_from.heading_rad(i), in_rad);
        if (ends.start_rad) at->cost += cost_.turn(*ends.start_rad, fan_from.heading_rad(i));
        if (ends.goal_rad) at->cost += cost_.turn(in_rad, *ends.goal_rad);
        if (at->cost < limit) meetings_.push_back(*at);
      }
    }
    std::ranges::sort(meetings_, {}, &Meeting::cost);
    return meetings_;
  }

  /// With the cost of its two legs.
  [[nodiscard]] std::optional<Meeting> meeting(const Fan& fan_from, std::size_t i, const Fan& fan_to,
                                               std::size_t k) const {
    const Vec2& a = fan_from.direction(i);
    const Vec2& b = fan_to.direction(k);
    const double parallel = cross(a, b);
    if (std::abs(parallel) < 1e-9) return std::nullopt;
    const Vec2 between = fan_to.apex() - fan_from.apex();
    const double length_from = cross(between, b) / parallel;
    const double length_to = cross(between, a) / parallel;
    if (length_from <= 0.0 || length_to <= 0.0) return std::nullopt;
    return Meeting{cost_.at_least(length_from) + cost_.at_least(length_to), i, k, length_from, length_to};
  }

  std::vector<Vec2> points_;
  EndHeadings headings_;
  const CollisionChecker& space_;
  const PathCost& cost_;
  std::vector<Meeting> meetings_;
  std::size_t work_ = 0;
};

}  // namespace

CountedPath with_turns_merged(std::vector<Vec2> points, const EndHeadings& headings,
                              const CollisionChecker& space, const PathCost& cost) {
  return TurnMerging(std::move(points), headings, space, cost).run();
}

}  // namespace lodestar
