#include "localization/survey/wheel_segment.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// One step of dead reckoning along its chord, and the derivatives of (way, turn) after it.
struct Step {
  double turn_rad = 0.0;
  double along_m = 0.0;
  Vec2 direction = Vec2::UnitX();  ///< of the chord, in the segment's first frame
};

Step step_of(const Vec2& rolled_m, double heading_rad, const WheelGauge& gauge) {
  const double left = (1.0 - gauge.difference) * rolled_m.x();
  const double right = (1.0 + gauge.difference) * rolled_m.y();
  Step step{.turn_rad = (right - left) / gauge.track_m, .along_m = 0.5 * (left + right)};
  const double middle = heading_rad + 0.5 * step.turn_rad;
  step.direction = {std::cos(middle), std::sin(middle)};
  return step;
}

Vec2 turned_left(const Vec2& v) {
  return {-v.y(), v.x()};
}

}  // namespace

std::optional<Vec2> travel_at(std::span<const WheelTravel> readings, Stamp stamp, Duration most_gap) {
  const auto after = std::ranges::lower_bound(readings, stamp, {}, &WheelTravel::stamp);
  if (after == readings.end()) return std::nullopt;
  const Vec2 at_after(after->left_m, after->right_m);
  if (after->stamp == stamp) return at_after;
  if (after == readings.begin()) return std::nullopt;
  const WheelTravel& before = *std::prev(after);
  if (after->stamp - before.stamp > most_gap) return std::nullopt;
  const double share = seconds(stamp - before.stamp) / seconds(after->stamp - before.stamp);
  const Vec2 at_before(before.left_m, before.right_m);
  return Vec2(at_before + share * (at_after - at_before));
}

std::optional<WheelSegment> WheelSegment::between(std::span<const WheelTravel> readings, Stamp from, Stamp to,
                                                  Duration most_gap) {
  const std::optional<Vec2> first = travel_at(readings, from, most_gap);
  const std::optional<Vec2> last = travel_at(readings, to, most_gap);
  if (!first || !last) return std::nullopt;
  WheelSegment segment;
  Vec2 before = *first;
  Stamp at = from;
  const auto add = [&](const Vec2& travel) {
    if (travel != before) segment.steps_m_.emplace_back(travel - before);
    before = travel;
  };
  for (auto i = std::ranges::upper_bound(readings, from, {}, &WheelTravel::stamp);
       i != readings.end() && i->stamp < to; ++i) {
    if (i->stamp - at > most_gap) return std::nullopt;
    at = i->stamp;
    add({i->left_m, i->right_m});
  }
  add(*last);
  return segment;
}

WheelMotion WheelSegment::motion(const WheelGauge& gauge) const {
  WheelMotion motion;
  for (const Vec2& rolled : steps_m_) {
    const Step step = step_of(rolled, motion.turn_rad, gauge);
    // Turn and way of this step by (difference, track).
    const Eigen::RowVector2d turn_by((rolled.x() + rolled.y()) / gauge.track_m,
                                     -step.turn_rad / gauge.track_m);
    const Eigen::RowVector2d along_by(0.5 * (rolled.y() - rolled.x()), 0.0);
    const Eigen::RowVector2d middle_by = motion.by_gauge.row(2) + 0.5 * turn_by;
    motion.by_gauge.topRows<2>() +=
        step.direction * along_by + step.along_m * turned_left(step.direction) * middle_by;
    motion.by_gauge.row(2) += turn_by;
    motion.way_m += step.along_m * step.direction;
    motion.turn_rad += step.turn_rad;
  }
  return motion;
}

Eigen::Matrix3d WheelSegment::covariance(const WheelGauge& gauge, const WheelNoise& noise) const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double heading = 0.0;
  Vec2 direction = Vec2::UnitX();
  const auto add = [&](const Vec2& variance_of_wheels, double sideways_variance, double along_m) {
    for (int wheel = 0; wheel < 2; ++wheel) {
      const double turn = (wheel == 0 ? -1.0 : 1.0) / gauge.track_m;
      Vec3 by;
      by << 0.5 * direction + 0.5 * along_m * turn * turned_left(direction), turn;
      covariance += variance_of_wheels[wheel] * by * by.transpose();
    }
    Vec3 aside;
    aside << turned_left(direction), 0.0;
    covariance += sideways_variance * aside * aside.transpose();
  };
  for (const Vec2& rolled : steps_m_) {
    const Step step = step_of(rolled, heading, gauge);
    // Heading errors so far swing this step's way.
    Eigen::Matrix3d carried = Eigen::Matrix3d::Identity();
    carried.topRightCorner<2, 1>() = step.along_m * turned_left(step.direction);
    covariance = carried * covariance * carried.transpose();
    direction = step.direction;
    add(square(noise.slip_sigma_per_sqrt_m) * rolled.cwiseAbs(),
        square(noise.sideways_sigma_per_sqrt_m) * 0.5 * rolled.cwiseAbs().sum(), step.along_m);
    heading += step.turn_rad;
  }
  // Both ends are read; what is between them cancels.
  add(2.0 * square(noise.encoder_sigma_m) * Vec2::Ones(), square(noise.encoder_sigma_m), 0.0);
  return covariance;
}

double WheelSegment::rolled_m() const {
  double sum = 0.0;
  for (const Vec2& step : steps_m_) sum += 0.5 * step.cwiseAbs().sum();
  return sum;
}

Vec2 WheelSegment::travel_m() const {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& step : steps_m_) sum += step;
  return sum;
}

}  // namespace lodestar
