#include "app/fleet/fleet_link.hpp"

#include <utility>

namespace lodestar {

std::vector<FleetMessage> FleetLink::take_messages() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return {};
  return std::exchange(messages_, {});
}

bool FleetLink::publish(FleetReport report) {
  std::optional<FleetReport> old;  // destroyed after the lock is given back
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return false;
  old = std::exchange(report_, std::move(report));
  return true;
}

bool FleetLink::give(FleetMessage message) {
  constexpr std::size_t most_waiting = 256;
  const std::lock_guard lock(mutex_);
  if (messages_.size() >= most_waiting) return false;
  messages_.push_back(std::move(message));
  return true;
}

std::optional<FleetReport> FleetLink::newest() {
  const std::lock_guard lock(mutex_);
  return std::exchange(report_, std::nullopt);
}

}  // namespace lodestar
