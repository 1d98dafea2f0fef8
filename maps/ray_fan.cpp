#include "maps/ray_fan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestar {
namespace {

constexpr int bins = 1024;
constexpr double full_turn = 4.0;

/// Grows with the angle, by 1 a quarter turn, and by at most 1 a radian: cheaper than an arc tangent.
double turn_of(const Vec2& way) {
  const double sum = std::abs(way.x()) + std::abs(way.y());
  if (sum == 0.0) return 0.0;
  const double part = way.y() / sum;
  if (way.x() < 0.0) return 2.0 - part;
  return part < 0.0 ? full_turn + part : part;
}

int bin_of(double turn) {
  return std::min(static_cast<int>(turn * (bins / full_turn)), bins - 1);
}

/// A hit that both rays beside it go past by more than neighbours on one surface differ.
bool is_alone(const DeskewedScan& scan, std::size_t i) {
  constexpr double beyond_m = 0.15;
  const std::size_t count = scan.rays.size();
  const Ray& ray = scan.rays[i];
  const auto goes_past = [&](const Ray& beside) {
    return beside.echo == Echo::invalid || range_m(beside) > range_m(ray) + beyond_m;
  };
  return ray.echo == Echo::hit && goes_past(scan.rays[(i + count - 1) % count]) &&
         goes_past(scan.rays[(i + 1) % count]);
}

}  // namespace

RayFan::RayFan(const DeskewedScan& scan) {
  lines_.reserve(scan.rays.size());
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const Ray& ray = scan.rays[i];
    const Vec2 way = ray.end_m - ray.origin_m;
    const double length_m = way.norm();
    if (length_m == 0.0) continue;
    lines_.push_back(
        {ray.origin_m, way / length_m, length_m, turn_of(way), ray.echo == Echo::invalid, is_alone(scan, i)});
    middle_m_ += ray.origin_m;
  }
  if (!lines_.empty()) middle_m_ /= static_cast<double>(lines_.size());
  for (const Line& line : lines_) spread_m_ = std::max(spread_m_, (line.origin_m - middle_m_).norm());
  std::ranges::sort(lines_, {}, &Line::turn);
  first_.assign(bins + 1, static_cast<std::int32_t>(lines_.size()));
  for (std::size_t i = lines_.size(); i-- > 0;)
    first_[static_cast<std::size_t>(bin_of(lines_[i].turn))] = static_cast<std::int32_t>(i);
  for (std::size_t bin = bins; bin-- > 0;) first_[bin] = std::min(first_[bin], first_[bin + 1]);
}

/// Asks `more(Look)` of each ray that looks past the point within `aside_m`, while that says so.
template <typename More>
void RayFan::ask_beside(const Vec2& point_m, double aside_m, const More& more) const {
  const Vec2 to_point = point_m - middle_m_;
  const double away_m = to_point.norm();
  const double room_m = aside_m + spread_m_;
  if (lines_.empty() || away_m <= 2.0 * room_m) return;  // under the scanner: it sees nothing there
  const double turn = turn_of(to_point);
  // The arc sine of up to a half is less than 1.05 times its argument.
  const double window = 1.05 * room_m / away_m;
  const int from = static_cast<int>(std::floor((turn - window) * (bins / full_turn)));
  const int to = static_cast<int>(std::floor((turn + window) * (bins / full_turn)));
  for (int i = from; i <= to; ++i) {
    const auto bin = static_cast<std::size_t>((i % bins + bins) % bins);
    for (std::int32_t at = first_[bin]; at < first_[bin + 1]; ++at) {
      const Line& line = lines_[static_cast<std::size_t>(at)];
      const Vec2 offset = point_m - line.origin_m;
      const double along_m = offset.dot(line.way);
      const double left_m = cross(line.way, offset);
      if (along_m <= 0.0 || std::abs(left_m) >= aside_m) continue;
      if (!more(Look{line, left_m, line.length_m - along_m})) return;
    }
  }
}

bool RayFan::passes(const Vec2& point_m, double aside_m, double before_end_m) const {
  bool has_passed = false;
  ask_beside(point_m, aside_m, [&](const Look& look) {
    has_passed = !look.line.is_lost && look.beyond_m > before_end_m;
    return !has_passed;
  });
  return has_passed;
}

std::array<const RayFan::Line*, 2> RayFan::nearest_beside(const Vec2& point_m, double aside_m) const {
  std::array<const Line*, 2> nearest{};
  std::array<double, 2> nearest_m{aside_m, aside_m};
  ask_beside(point_m, aside_m, [&](const Look& look) {
    const std::size_t side = look.aside_m < 0.0 ? 0 : 1;
    if (look.line.is_lost || std::abs(look.aside_m) >= nearest_m[side]) return true;
    nearest_m[side] = std::abs(look.aside_m);
    nearest[side] = &look.line;
    return true;
  });
  return nearest;
}

bool RayFan::graze(const Vec2& point_m, double aside_m, double along_m) const {
  constexpr double joins_m = 0.8;         // ends farther apart are of different things
  constexpr double least_cosine = 0.985;  // 10 degrees: at more, each cell of a surface is hit in each scan
  // 3 standard deviations of the range, and half a degree by which the odometry frame has turned since.
  constexpr double off_m = 0.015;
  constexpr double off_per_m = 0.01;
  const auto [left, right] = nearest_beside(point_m, aside_m);
  if (left == nullptr || right == nullptr) return false;
  const Vec2 surface = right->end_m() - left->end_m();
  const double length_m = surface.norm();
  if (length_m == 0.0 || length_m > joins_m) return false;
  const Vec2 way = surface / length_m;
  const Vec2 offset = point_m - left->end_m();
  const double at_m = way.dot(offset);
  return std::abs(way.dot(left->way)) >= least_cosine && at_m >= -along_m && at_m <= length_m + along_m &&
         std::abs(cross(way, offset)) <= off_m + off_per_m * left->length_m;
}

std::optional<RayFan::PassedParts> RayFan::passed_across(const Vec2& point_m, double aside_m,
                                                         double before_end_m, double gap_m) const {
  PassedParts passed;
  // From the left of the point to its right, as rays are asked.
  const auto part_at = [&](double at_m) {
    const double share = std::clamp(0.5 * (aside_m - at_m) / aside_m, 0.0, 1.0);
    return static_cast<std::size_t>(std::lround(share * static_cast<double>(parts_across)));
  };
  const auto pass = [&](double from_m, double to_m) {
    for (std::size_t part = part_at(from_m); part < part_at(to_m); ++part) passed.set(part);
  };
  bool any_ends = false;
  bool has_left = false;
  bool has_right = false;
  bool is_in_doubt = false;
  double known_to_m = aside_m;  // where the last one looked past that tells something
  bool passes = false;          // did that go on?
  const auto ask = [&](const Look& look) {
    const bool is_beside = std::abs(look.aside_m) < aside_m;
    const bool goes_on = look.beyond_m > before_end_m;
    if (look.line.is_lost || (look.line.is_alone && goes_on)) {
      is_in_doubt = is_in_doubt || is_beside;
      return true;
    }
    const bool did_pass = std::exchange(passes, goes_on);
    const bool hides_nothing = did_pass && passes && known_to_m - look.aside_m <= thin_thing_m;
    if (hides_nothing || !is_in_doubt) pass(known_to_m, look.aside_m);
    is_in_doubt = false;
    known_to_m = look.aside_m;
    if (!is_beside) return true;
    any_ends = !passes;
    has_left = has_left || (look.aside_m >= 0.0 && look.aside_m <= gap_m);
    has_right = has_right || (look.aside_m <= 0.0 && look.aside_m >= -gap_m);
    return !any_ends;
  };
  ask_beside(point_m, aside_m + thin_thing_m, ask);  // those farther aside tell of lost ones at the edge
  if (any_ends || !has_left || !has_right) return std::nullopt;
  if (!is_in_doubt) pass(known_to_m, -aside_m);
  return passed;
}

}  // namespace lodestar
