#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "maps/geometry.hpp"

namespace lodestar {

/// What a disc covers on a straight leg: a capsule. Convex, so the part of it between two heights has one
/// extent in x, and a square between them overlaps the capsule exactly if it overlaps that extent.
class SweptDisc {
 public:
  SweptDisc(const Vec2& from, const Vec2& to, double radius)
      : left_(from), right_(to), radius_(radius), squared_radius_(radius * radius) {
    if (right_.x() < left_.x()) std::swap(left_, right_);
    const Vec2 leg = right_ - left_;
    const double length = leg.norm();
    if (length == 0.0 || leg.y() == 0.0) return;
    x_per_y_ = leg.x() / leg.y();
    side_ = radius / length * Vec2(std::abs(leg.y()), leg.y() > 0.0 ? -leg.x() : leg.x());
    is_level_ = false;
  }

  [[nodiscard]] double lowest_y() const { return std::min(left_.y(), right_.y()) - radius_; }
  [[nodiscard]] double highest_y() const { return std::max(left_.y(), right_.y()) + radius_; }

  /// Greatest x between two heights of which at least one lies within the capsule's.
  [[nodiscard]] double greatest_x(double low_y, double high_y) const {
    return boundary_x(std::clamp(right_.y(), low_y, high_y), 1.0);
  }
  [[nodiscard]] double least_x(double low_y, double high_y) const {
    return boundary_x(std::clamp(left_.y(), low_y, high_y), -1.0);
  }

 private:
  /// On the right (1) or left (-1): the leg set off to that side, or beyond it an end's circle.
  [[nodiscard]] double boundary_x(double y, double sign) const {
    if (is_level_) return around(sign > 0.0 ? right_ : left_, y, sign);
    const Vec2 offset = sign * side_;
    const double up = y - offset.y() - left_.y();
    const double all = right_.y() - left_.y();
    if (up * all <= 0.0) return around(left_, y, sign);
    if (std::abs(up) >= std::abs(all)) return around(right_, y, sign);
    return left_.x() + offset.x() + up * x_per_y_;
  }

  [[nodiscard]] double around(const Vec2& end, double y, double sign) const {
    const double up = y - end.y();
    return end.x() + sign * std::sqrt(std::max(squared_radius_ - up * up, 0.0));
  }

  Vec2 left_;
  Vec2 right_;
  double radius_ = 0.0;
  double squared_radius_ = 0.0;
  bool is_level_ = true;  ///< or a point
  double x_per_y_ = 0.0;
  Vec2 side_ = Vec2::Zero();  ///< from the leg to its right edge
};

}  // namespace lodestar
