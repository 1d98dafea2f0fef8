#include "localization/calibration/time_offset.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

/// The heading by the wheels, linear between readings.
class WheelHeading {
 public:
  WheelHeading(std::span<const WheelTravel> wheels, double track_width_m)
      : wheels_(wheels), track_width_m_(track_width_m) {}

  [[nodiscard]] bool covers(Stamp from, Stamp to) const {
    return !wheels_.empty() && wheels_.front().stamp <= from && to <= wheels_.back().stamp;
  }

  /// The mean about a time, which is all covered: without the steps of the encoders.
  [[nodiscard]] double about(Stamp stamp) const {
    constexpr Duration apart = std::chrono::milliseconds(10);
    constexpr int to_each_side = 3;
    double sum_rad = 0.0;
    for (int i = -to_each_side; i <= to_each_side; ++i) sum_rad += at(stamp + i * apart);
    return sum_rad / (2 * to_each_side + 1);
  }

 private:
  [[nodiscard]] double at(Stamp stamp) const {
    const auto after = std::ranges::lower_bound(wheels_, stamp, {}, &WheelTravel::stamp);
    if (after == wheels_.begin()) return heading_of(*after);
    if (after == wheels_.end()) return heading_of(wheels_.back());
    const WheelTravel& before = *std::prev(after);
    const double share = seconds(stamp - before.stamp) / seconds(after->stamp - before.stamp);
    return std::lerp(heading_of(before), heading_of(*after), share);
  }
  [[nodiscard]] double heading_of(const WheelTravel& travel) const {
    return (travel.right_m - travel.left_m) / track_width_m_;
  }

  std::span<const WheelTravel> wheels_;
  double track_width_m_;
};

/// Two successive frames, and the turn between them.
struct Pair {
  Stamp from;
  Stamp to;
  double turned_rad = 0.0;
};

std::vector<Pair> pairs_of(std::span<const HeadingSample> frames, const WheelHeading& wheels,
                           const TimeOffsetOptions& options) {
  std::vector<Pair> pairs;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const HeadingSample& from = frames[i - 1];
    const HeadingSample& to = frames[i];
    if (to.stamp - from.stamp > options.longest_gap) continue;
    if (!wheels.covers(from.stamp - options.largest, to.stamp + options.largest)) continue;
    pairs.push_back({from.stamp, to.stamp, wrap_angle(to.yaw_rad - from.yaw_rad)});
  }
  return pairs;
}

/// Sum of the squared differences of the turns when the frames were exposed `late` before their stamps. The
/// wheels' turns are scaled to fit best: track width and wheels are known roughly.
double misfit(std::span<const Pair> pairs, const WheelHeading& wheels, Duration late) {
  double seen_seen = 0.0;
  double seen_rolled = 0.0;
  double rolled_rolled = 0.0;
  for (const Pair& pair : pairs) {
    const double rolled_rad = wheels.about(pair.to - late) - wheels.about(pair.from - late);
    seen_seen += pair.turned_rad * pair.turned_rad;
    seen_rolled += pair.turned_rad * rolled_rad;
    rolled_rolled += rolled_rad * rolled_rad;
  }
  return rolled_rolled > 0.0 ? seen_seen - seen_rolled * seen_rolled / rolled_rolled : seen_seen;
}

/// level + slope * x + bend * x^2, with x in seconds from the middle.
struct Parabola {
  double slope = 0.0;
  double bend = 0.0;
};

/// Least squares over the costs to both sides of the middle: the vertex is the offset, the bend the
/// information about it.
Parabola parabola_through(const std::function<double(Duration)>& cost, Duration middle,
                          const TimeOffsetOptions& options) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  for (Duration x = -options.width; x <= options.width; x += options.step) {
    const Vec3 powers(1.0, seconds(x), seconds(x) * seconds(x));
    normal += powers * powers.transpose();
    right += cost(middle + x) * powers;
  }
  const Vec3 fitted = normal.ldlt().solve(right);
  return {.slope = fitted.y(), .bend = fitted.z()};
}

}  // namespace

bool TimeOffset::is_significant() const {
  constexpr double clearly = 3.0;  // standard deviations
  return std::abs(late_s) > clearly * sigma_s;
}

std::optional<TimeOffset> estimate_time_offset(std::span<const HeadingSample> frames,
                                               std::span<const WheelTravel> wheels, double track_width_m,
                                               const TimeOffsetOptions& options) {
  const WheelHeading heading(wheels, track_width_m);
  const std::vector<Pair> pairs = pairs_of(frames, heading, options);
  if (pairs.size() < options.least_pairs) return std::nullopt;
  const auto cost = [&](Duration late) { return misfit(pairs, heading, late); };

  Duration best = -options.largest;
  double least = cost(best);
  for (Duration late = best + options.step; late <= options.largest; late += options.step) {
    const double here = cost(late);
    if (here < least) {
      least = here;
      best = late;
    }
  }
  if (best - options.width < -options.largest || best + options.width > options.largest) return std::nullopt;
  const Parabola parabola = parabola_through(cost, best, options);
  const double variance = least / static_cast<double>(pairs.size() - 2);
  // Whole encoder steps make the costs rough: a dent no deeper than that is not the offset.
  const double width_s = seconds(options.width);
  const double roughness = variance * std::sqrt(2.0 * static_cast<double>(pairs.size()));
  constexpr double clearly = 5.0;
  if (parabola.bend * width_s * width_s < clearly * roughness) return std::nullopt;
  const TimeOffset found{.late_s = seconds(best) - parabola.slope / (2.0 * parabola.bend),
                         .sigma_s = std::sqrt(variance / parabola.bend)};
  return found.sigma_s <= options.most_sigma_s ? std::optional(found) : std::nullopt;
}

}  // namespace lodestar
