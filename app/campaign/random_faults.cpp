#include "app/campaign/random_faults.hpp"

#include <algorithm>
#include <functional>
#include <numbers>

#include "maps/random.hpp"

namespace lodestar {
namespace {

int how_many(Random& random) {
  const double chance = random.uniform();
  if (chance < 0.08) return 0;
  if (chance < 0.68) return 1;
  return chance < 0.90 ? 2 : 3;
}

std::optional<Duration> passing(double least_s, double most_s, Random& random) {
  const bool lasts_to_the_end = random.uniform() < 0.15;
  const double lasts_s = random.uniform(least_s, most_s);
  return lasts_to_the_end ? std::nullopt : std::optional(from_seconds(lasts_s));
}

constexpr double until_it_has_a_pose_s = 1.5;  ///< after the camera first delivers usable frames

/// Faults that cannot be detected before the robot has seen another marker, and that would give it a wrong
/// first pose. They begin once the robot has a pose.
bool may_mislead_at_the_start(FaultKind kind) {
  return misleads(kind) || kind == FaultKind::kidnapping;
}

bool blinds(const Fault& fault) {
  using enum FaultKind;
  switch (fault.kind) {
    case markers_occluded:
    case camera_frozen:
    case camera_dropped:
    case camera_black:
    case camera_saturated:
    case camera_blurred:
    case camera_late:
    case clock_jump:
      return true;
    default:
      return false;
  }
}

/// All but the disk faults: a campaign mission writes no run folder.
std::vector<FaultKind> kinds_of_faults(bool has_scanner) {
  std::vector<FaultKind> kinds = all_fault_kinds();
  std::erase_if(kinds, [&](FaultKind kind) {
    return kind == FaultKind::disk_full || kind == FaultKind::disk_slow ||
           (concerns_scanner(kind) && !has_scanner);
  });
  return kinds;
}

/// When the camera first delivers usable frames; nothing when it never does.
std::optional<Duration> first_usable_frame(std::vector<Fault> faults) {
  std::ranges::sort(faults, {}, &Fault::begin);
  Duration sees{};
  for (const Fault& fault : faults) {
    if (!blinds(fault) || fault.begin > sees + from_seconds(until_it_has_a_pose_s)) continue;
    if (!fault.lasts) return std::nullopt;
    sees = std::max(sees, fault.begin + *fault.lasts);
  }
  return sees;
}

bool are_on_together(const Fault& one, const Fault& other) {
  const auto end = [](const Fault& fault) {
    return fault.lasts ? fault.begin + *fault.lasts : Duration::max();
  };
  return one.begin < end(other) && other.begin < end(one);
}

/// Removes what no sensor on board could detect: a kidnapping in a mission with a blinding fault, wheel slip
/// during one, and misleading markers before the first pose.
void remove_undetectable(std::vector<Fault>& faults) {
  const std::optional<Duration> sees = first_usable_frame(faults);
  std::vector<Fault> blinding = faults;
  std::erase_if(blinding, std::not_fn(blinds));
  std::erase_if(faults, [&](const Fault& fault) {
    if (fault.kind == FaultKind::kidnapping) return !blinding.empty();
    if (fault.kind == FaultKind::wheel_slip)
      return std::ranges::any_of(blinding, [&](const Fault& other) { return are_on_together(fault, other); });
    return may_mislead_at_the_start(fault.kind) &&
           (!sees || fault.begin < *sees + from_seconds(until_it_has_a_pose_s));
  });
}

Fault random_fault(FaultKind kind, Random random) {
  constexpr double pi = std::numbers::pi;
  Fault fault{.kind = kind};
  const bool from_the_start = random.uniform() < 0.15 && !may_mislead_at_the_start(kind);
  const double begin_s = random.uniform(until_it_has_a_pose_s, 12.0);
  fault.begin = from_seconds(from_the_start ? 0.0 : begin_s);
  fault.direction_rad = random.uniform(-pi, pi);
  switch (kind) {
    case FaultKind::marker_moved:
      fault.shift_m = random.uniform(0.05, 0.5);
      fault.turn_rad = random.uniform() < 0.5 ? 0.0 : random.uniform(-0.5, 0.5);
      break;
    case FaultKind::marker_duplicated:
      fault.shift_m = random.uniform(0.25, 1.0);
      fault.turn_rad = random.uniform(-pi, pi);
      break;
    case FaultKind::markers_occluded:
    case FaultKind::camera_frozen:
    case FaultKind::camera_dropped:
    case FaultKind::camera_black:
    case FaultKind::camera_saturated:
      fault.lasts = passing(0.2, 8.0, random);
      break;
    case FaultKind::camera_blurred:
      fault.lasts = passing(0.2, 8.0, random);
      fault.blur_sigma_px = random.uniform(1.0, 10.0);
      break;
    case FaultKind::camera_late:
      fault.lasts = passing(0.5, 8.0, random);
      fault.delay_s = random.uniform(0.0, 0.6);
      break;
    case FaultKind::clock_jump:
      fault.lasts = passing(0.5, 8.0, random);
      fault.delay_s = random.uniform() < 0.5 ? 3600.0 : -3600.0;
      break;
    case FaultKind::decoy_lamps:
      fault.count = 5.0 + static_cast<double>(random.below(60));
      fault.shift_m = random.uniform(0.1, 0.6);
      break;
    case FaultKind::can_loss:
    case FaultKind::can_duplication:
    case FaultKind::can_corruption:
      fault.lasts = passing(1.0, 10.0, random);
      fault.share = random.uniform(0.0, 0.5);
      break;
    case FaultKind::can_delay:
      fault.lasts = passing(1.0, 10.0, random);
      fault.delay_s = random.uniform(0.0, 0.06);
      break;
    case FaultKind::wheel_slip:
      fault.lasts = from_seconds(random.uniform(0.2, 3.0));
      fault.left_share = random.uniform(-0.2, 0.6);
      fault.right_share = random.uniform(-0.2, 0.6);
      break;
    case FaultKind::kidnapping:
      fault.shift_m = random.uniform(0.4, 3.0);
      fault.turn_rad = random.uniform(-pi, pi);
      break;
    case FaultKind::scanner_silent:
    case FaultKind::scanner_frozen:
      fault.lasts = passing(0.2, 8.0, random);
      break;
    case FaultKind::scanner_beams_dropped:
      fault.lasts = passing(0.2, 8.0, random);
      fault.share = random.uniform(0.1, 1.0);
      break;
    case FaultKind::scanner_packets_lost:
      fault.lasts = passing(0.5, 8.0, random);
      fault.share = random.uniform(0.0, 0.5);
      break;
    case FaultKind::scanner_dirty:
      // Dirt that shows nothing can hide a person for as long as it takes to notice it, where it is wider
      // than a body at the distance that the field keeps.
      fault.share = random.uniform() < 0.5 ? 0.0 : random.uniform(0.1, 1.0);
      fault.width_rad = random.uniform(0.03, fault.share > 0.0 ? 1.0 : 0.14);
      break;
    case FaultKind::scanner_late:
      fault.lasts = passing(0.5, 8.0, random);
      fault.delay_s = random.uniform(0.0, 0.6);
      break;
    case FaultKind::scanner_clock:
      fault.lasts = passing(0.5, 8.0, random);
      fault.delay_s = random.uniform() < 0.5 ? 0.0 : 3600.0 * random.uniform(-1.0, 1.0);
      fault.drift_s_per_s = random.uniform(-0.05, 0.05);
      break;
    case FaultKind::scanner_motor:
      fault.lasts = passing(1.0, 8.0, random);
      fault.share = random.uniform(0.1, 1.5);
      break;
    case FaultKind::scanner_turned:
      fault.turn_rad = random.uniform(-0.2, 0.2);
      break;
    case FaultKind::marker_wrong_id:
    case FaultKind::markers_swapped:
    case FaultKind::encoder_stuck:
    case FaultKind::disk_full:
    case FaultKind::disk_slow:
      break;
  }
  return fault;
}

}  // namespace

bool misleads(FaultKind kind) {
  using enum FaultKind;
  return kind == marker_moved || kind == marker_wrong_id || kind == markers_swapped ||
         kind == marker_duplicated;
}

std::vector<Fault> random_faults(std::uint64_t seed, bool has_scanner) {
  Random random(seed);
  const std::vector<FaultKind> kinds = kinds_of_faults(has_scanner);
  std::vector<Fault> faults(static_cast<std::size_t>(how_many(random)));
  std::uint64_t number = 1;
  for (Fault& fault : faults)
    fault = random_fault(kinds[random.below(kinds.size())], Random(seed).stream(number++));
  remove_undetectable(faults);
  return faults;
}

}  // namespace lodestar
