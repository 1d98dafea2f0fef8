#include "drivers/simulation/sliding_door.hpp"

#include <algorithm>
#include <cmath>

#include "maps/segment.hpp"

namespace lodestar {
namespace {

constexpr double disc_radius_m = 0.04;    ///< half of the leaf's thickness
constexpr double between_discs_m = 0.07;  ///< less than a disc is wide: no beam passes
constexpr double slides_mps = 0.5;        ///< a leaf ...
constexpr double starts_mps2 = 1.0;       ///< ... of some 50 kg
/// From the line between the posts to the middle of who is there. Chosen by hand, so that a leaf that must
/// turn back first, for 25 cm, touches no one who walks in.
constexpr double presence_m = 1.0;

double distance_m(const Vec2& point_m, const SlidingDoor& door) {
  return distance_to_segment(door.from_m, door.to_m, point_m);
}

}  // namespace

SlidingLeaf::SlidingLeaf(const SlidingDoor& door) : door_(door), width_m_((door.to_m - door.from_m).norm()) {
  const auto count = static_cast<std::size_t>(std::ceil(width_m_ / between_discs_m)) + 1;
  discs_.assign(count, DiscState{.radius_m = disc_radius_m});
  place_discs();
}

bool SlidingLeaf::is_wanted_shut(Stamp now, std::span<const Vec2> present_m) const {
  const Duration time = now.time_since_epoch();
  if (time < door_.shuts || (door_.opens && time >= *door_.opens)) return false;
  const bool is_shut = out_m_ >= width_m_;
  return is_shut || std::ranges::none_of(
                        present_m, [&](const Vec2& who_m) { return distance_m(who_m, door_) < presence_m; });
}

void SlidingLeaf::step(Stamp now, Duration by, std::span<const Vec2> present_m) {
  const double by_s = seconds(by);
  const double to_go_m = (is_wanted_shut(now, present_m) ? width_m_ : 0.0) - out_m_;
  // As fast as it may be to come to rest there.
  const double wanted_mps =
      std::copysign(std::min(slides_mps, std::sqrt(2.0 * starts_mps2 * std::abs(to_go_m))), to_go_m);
  const double most_mps = starts_mps2 * by_s;
  speed_mps_ += std::clamp(wanted_mps - speed_mps_, -most_mps, most_mps);
  out_m_ = std::clamp(out_m_ + speed_mps_ * by_s, 0.0, width_m_);
  const bool has_met_its_end = out_m_ <= 0.0 || out_m_ >= width_m_;
  if (has_met_its_end) speed_mps_ = 0.0;
  place_discs();
}

void SlidingLeaf::place_discs() {
  const Vec2 along = (door_.to_m - door_.from_m) / width_m_;
  const double spacing_m = width_m_ / static_cast<double>(discs_.size() - 1);
  // Of the last disc in the wall, from the post: an open door does not stick out of it.
  double place_m = out_m_ - width_m_ - disc_radius_m;
  for (DiscState& disc : discs_) {
    disc.position_m = door_.from_m + place_m * along;
    disc.velocity_mps = speed_mps_ * along;
    place_m += spacing_m;
  }
}

}  // namespace lodestar
