#include "app/live/live_link.hpp"

#include <utility>

namespace lodestar {

void LiveLink::publish(RobotState state) {
  std::optional<RobotState> old;  // destroyed after the lock is given back
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  old = std::exchange(state_, std::move(state));
  wanted_.store(false, std::memory_order_release);
}

std::vector<Order> LiveLink::take_orders() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return {};
  return std::exchange(orders_, {});
}

std::string LiveLink::stopped_by() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? std::exchange(stopped_by_, {}) : "";
}

void LiveLink::stop(std::string by) {
  stop_.store(true);  // before the lock, which the name alone needs
  const std::lock_guard lock(mutex_);
  stopped_by_ = std::move(by);
}

std::optional<RobotState> LiveLink::newest() {
  const std::lock_guard lock(mutex_);
  return std::exchange(state_, std::nullopt);
}

bool LiveLink::give(Order order) {
  constexpr std::size_t most_waiting = 32;
  const std::lock_guard lock(mutex_);
  if (orders_.size() >= most_waiting) return false;
  orders_.push_back(std::move(order));
  return true;
}

}  // namespace lodestar
