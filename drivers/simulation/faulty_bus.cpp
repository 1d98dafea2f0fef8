#include "drivers/simulation/faulty_bus.hpp"

#include <algorithm>

namespace lodestar {
namespace {

/// What a controller may receive when another node misbehaves: a truncated frame, or random data with an
/// unused identifier. A bit flipped on the wire would not pass the CRC.
CanFrame corrupted(CanFrame frame, Random& random) {
  if (random.uniform() < 0.5) {
    frame.length = static_cast<std::uint8_t>(random.below(std::max<std::uint64_t>(1, frame.length)));
  } else {
    frame.id = 0x700U + static_cast<std::uint32_t>(random.below(0x100));
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random.below(256));
  }
  return frame;
}

}  // namespace

void FaultyBus::suffer(const std::vector<Fault>& active) {
  loss_ = duplication_ = corruption_ = delay_s_ = 0.0;
  for (const Fault& fault : active) {
    if (fault.kind == FaultKind::can_loss) loss_ = std::max(loss_, fault.share);
    if (fault.kind == FaultKind::can_duplication) duplication_ = std::max(duplication_, fault.share);
    if (fault.kind == FaultKind::can_corruption) corruption_ = std::max(corruption_, fault.share);
    if (fault.kind == FaultKind::can_delay) delay_s_ = std::max(delay_s_, fault.delay_s);
  }
  disturbed_ = loss_ > 0.0 || duplication_ > 0.0 || corruption_ > 0.0 || delay_s_ > 0.0;
}

void FaultyBus::advance(Stamp now) {
  now_ = now;
  while (!outgoing_.empty() && outgoing_.front().stamp <= now_) {
    (void)bus_.send(outgoing_.front().frame);
    outgoing_.pop_front();
  }
}

bool FaultyBus::send(const CanFrame& frame) {
  if (!disturbed_ && outgoing_.empty()) return bus_.send(frame);
  enqueue({now_, frame}, outgoing_);
  advance(now_);
  return true;
}

std::optional<StampedCanFrame> FaultyBus::poll() {
  if (!disturbed_ && incoming_.empty()) return bus_.poll();
  while (const auto received = bus_.poll()) enqueue(*received, incoming_);
  if (incoming_.empty() || incoming_.front().stamp > now_) return std::nullopt;
  const StampedCanFrame frame = incoming_.front();
  incoming_.pop_front();
  return frame;
}

void FaultyBus::enqueue(const StampedCanFrame& frame, std::deque<StampedCanFrame>& queue) {
  if (random_.uniform() < loss_) return;
  const int copies = random_.uniform() < duplication_ ? 2 : 1;
  for (int copy = 0; copy < copies; ++copy) {
    StampedCanFrame passed = frame;
    if (random_.uniform() < corruption_) passed.frame = corrupted(passed.frame, random_);
    passed.stamp += from_seconds(random_.uniform(0.0, delay_s_));
    const auto place = std::ranges::upper_bound(queue, passed.stamp, {}, &StampedCanFrame::stamp);
    queue.insert(place, passed);
  }
}

}  // namespace lodestar
