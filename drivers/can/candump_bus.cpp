#include "drivers/can/candump_bus.hpp"

#include "drivers/can/can_wire.hpp"

namespace lodestar {

CandumpBus::CandumpBus(std::vector<LoggedCanFrame> log, std::set<std::uint32_t> own, Stamp start)
    : log_(std::move(log)), own_(std::move(own)), now_(start) {
  if (!log_.empty()) shift_ = start - log_.front().received.stamp;
}

bool CandumpBus::send(const CanFrame& frame) {
  if (!is_valid(frame)) return false;
  ++counts_.sent;
  return true;
}

std::optional<StampedCanFrame> CandumpBus::poll() {
  while (!at_end()) {
    const StampedCanFrame& logged = log_[next_].received;
    if (logged.stamp + shift_ > now_) return std::nullopt;
    ++next_;
    if (own_.contains(logged.frame.id)) continue;
    ++counts_.received;
    return StampedCanFrame{logged.stamp + shift_, logged.frame};
  }
  return std::nullopt;
}

}  // namespace lodestar
