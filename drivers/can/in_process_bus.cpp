#include "drivers/can/in_process_bus.hpp"

#include <algorithm>
#include <utility>

#include "drivers/can/can_wire.hpp"

namespace lodestar {

class InProcessBus::End final : public CanBus {
 public:
  explicit End(InProcessBus& bus) : bus_(bus) {}

  bool send(const CanFrame& frame) override {
    if (!is_valid(frame) || waiting_.size() >= bus_.options_.transmit_queue) return false;
    waiting_.push_back({bus_.now_, frame});
    return true;
  }

  std::optional<StampedCanFrame> poll() override {
    if (arrived_.empty() || arrived_.front().stamp > bus_.now_) return std::nullopt;
    const StampedCanFrame frame = arrived_.front();
    arrived_.pop_front();
    return frame;
  }

  [[nodiscard]] const StampedCanFrame* next_to_send() const {
    return waiting_.empty() ? nullptr : &waiting_.front();
  }

  StampedCanFrame take_next_to_send() {
    const StampedCanFrame frame = waiting_.front();
    waiting_.pop_front();
    return frame;
  }

  /// False when there is no room.
  [[nodiscard]] bool receive(const StampedCanFrame& frame) {
    if (arrived_.size() >= bus_.options_.receive_queue) return false;
    arrived_.push_back(frame);
    return true;
  }

 private:
  InProcessBus& bus_;
  std::deque<StampedCanFrame> waiting_;  // stamped with the time of sending
  std::deque<StampedCanFrame> arrived_;
};

InProcessBus::InProcessBus(const InProcessBusOptions& options) : options_(options) {}
InProcessBus::~InProcessBus() = default;

CanBus& InProcessBus::attach() {
  return *ends_.emplace_back(std::make_unique<End>(*this));
}

void InProcessBus::advance(Stamp now) {
  now_ = std::max(now_, now);
  while (true) {
    if (!sending_) sending_ = begin_next();
    if (!sending_ || sending_->frame.stamp > now_) return;
    idle_since_ = sending_->frame.stamp;
    deliver(*std::exchange(sending_, std::nullopt));
  }
}

/// Arbitration: of all waiting frames the lowest identifier wins. All of them were sent before the time was
/// advanced, so none competes too early.
std::optional<InProcessBus::Sending> InProcessBus::begin_next() {
  End* winner = nullptr;
  for (const auto& end : ends_) {
    const StampedCanFrame* wish = end->next_to_send();
    if (wish == nullptr) continue;
    if (winner == nullptr || wish->frame.id < winner->next_to_send()->frame.id) winner = end.get();
  }
  if (winner == nullptr) return std::nullopt;
  const StampedCanFrame wish = winner->take_next_to_send();
  const Stamp begin = std::max(idle_since_, wish.stamp);
  const Duration on_wire = from_seconds(bits_on_wire(wish.frame) / options_.bit_rate_bps);
  return Sending{winner, {begin + on_wire, wish.frame}};
}

void InProcessBus::deliver(const Sending& sent) {
  if (listener_) listener_(sent.frame);
  for (const auto& end : ends_) {
    if (end.get() == sent.sender) continue;
    if (!end->receive({sent.frame.stamp + options_.latency, sent.frame.frame})) ++lost_frames_;
  }
}

}  // namespace lodestar
