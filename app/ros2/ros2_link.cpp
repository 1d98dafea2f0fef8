#include "app/ros2/ros2_link.hpp"

#include <utility>

namespace lodestar {

void Ros2Link::publish(Ros2Report report) {
  constexpr std::size_t most_waiting = 64;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;  // the next step is 20 ms away
  if (reports_.size() >= most_waiting) reports_.erase(reports_.begin());
  reports_.push_back(std::move(report));
}

std::vector<Ros2Command> Ros2Link::take_commands() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? std::exchange(commands_, {}) : std::vector<Ros2Command>{};
}

std::vector<OdometryReading> Ros2Link::take_odometry() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? std::exchange(odometry_, {}) : std::vector<OdometryReading>{};
}

std::vector<Ros2Report> Ros2Link::take_reports() {
  const std::lock_guard lock(mutex_);
  return std::exchange(reports_, {});
}

bool Ros2Link::give(Ros2Command command) {
  constexpr std::size_t most_waiting = 16;
  const std::lock_guard lock(mutex_);
  if (commands_.size() >= most_waiting) return false;
  commands_.push_back(command);
  return true;
}

void Ros2Link::give(const OdometryReading& reading) {
  constexpr std::size_t most_waiting = 256;  // a loop that takes none has ended or hangs
  const std::lock_guard lock(mutex_);
  if (odometry_.size() < most_waiting) odometry_.push_back(reading);
}

}  // namespace lodestar
