#include "drivers/system/device_clock.hpp"

#include <algorithm>

namespace lodestar {
namespace {

Duration scaled(Duration duration, double factor) {
  return Duration(static_cast<Duration::rep>(static_cast<double>(duration.count()) * factor));
}

}  // namespace

void DeviceClock::start(std::uint64_t ticks, Stamp arrival) {
  if (started_) ++restarts_;
  started_ = true;
  last_ticks_ = ticks;
  device_ = block_begin_ = Duration::zero();
  quickest_ = quickest_of_block_ = {Duration::zero(), arrival};
  block_before_.reset();
  blocks_ = 0;
  drift_ = 0.0;
  late_since_.reset();
}

/// Since the last delivery; nothing when the count ran backwards. Over less than half a wrap, forwards and
/// backwards differ.
std::optional<Duration> DeviceClock::elapsed(std::uint64_t ticks) const {
  const std::uint64_t wrap = options_.ticks_to_wrap;
  std::uint64_t forward = ticks - last_ticks_;
  if (wrap > 0) forward = (ticks % wrap + wrap - last_ticks_ % wrap) % wrap;
  const std::uint64_t most = wrap > 0 ? wrap / 2 : std::uint64_t{1} << 62U;
  const auto longest = static_cast<std::uint64_t>(Duration(std::chrono::hours(24 * 365)) / options_.tick);
  if (forward > std::min(most, longest)) return std::nullopt;
  return options_.tick * static_cast<Duration::rep>(forward);
}

bool DeviceClock::seems_restarted(Duration lateness, Stamp arrival) {
  if (lateness <= options_.restart_lateness) {
    late_since_.reset();
    return false;
  }
  if (!late_since_) late_since_ = arrival;
  return arrival - *late_since_ >= options_.restart_patience;
}

void DeviceClock::learn_drift(const Delivery& delivery) {
  const Duration since_quickest = delivery.device - quickest_of_block_.device;
  const bool is_quicker =
      delivery.arrival < quickest_of_block_.arrival + scaled(since_quickest, 1.0 + drift_);
  if (is_quicker) quickest_of_block_ = delivery;
  if (delivery.device - block_begin_ < options_.learning_time) return;
  if (block_before_) {
    const Duration on_device = quickest_of_block_.device - block_before_->device;
    const Duration on_robot = quickest_of_block_.arrival - block_before_->arrival;
    if (on_device >= options_.learning_time / 4) {
      const double seen =
          static_cast<double>((on_robot - on_device).count()) / static_cast<double>(on_device.count());
      const double gain = blocks_ == 1 ? 1.0 : 0.5;
      drift_ = std::clamp(drift_ + gain * (seen - drift_), -options_.max_drift, options_.max_drift);
    }
  }
  if (blocks_ < options_.learning_blocks) quickest_ = quickest_of_block_;
  ++blocks_;
  block_before_ = quickest_of_block_;
  quickest_of_block_ = delivery;
  block_begin_ = delivery.device;
}

Stamp DeviceClock::stamp_of(std::uint64_t ticks, Stamp arrival) {
  const std::optional<Duration> since_last = started_ ? elapsed(ticks) : std::nullopt;
  if (!since_last) {
    start(ticks, arrival);
    return arrival;
  }
  last_ticks_ = ticks;
  device_ += *since_last;
  const Stamp expected = quickest_.arrival + scaled(device_ - quickest_.device, 1.0 + drift_ + options_.leak);
  if (expected - arrival > options_.impossible_lead || seems_restarted(arrival - expected, arrival)) {
    start(ticks, arrival);
    return arrival;
  }
  const Stamp stamp = std::min(expected, arrival);
  quickest_ = {device_, stamp};
  learn_drift({device_, arrival});
  return stamp;
}

}  // namespace lodestar
