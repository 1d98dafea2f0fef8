#include "tests/can/witness.hpp"

#include <algorithm>
#include <cmath>
#include <poll.h>
#include <utility>

#include "drivers/system/clock.hpp"

namespace lodestar {

using namespace std::chrono_literals;

Witness::Witness(const std::string& interface) : bus_(interface), thread_([this] { listen(); }) {}

Witness::~Witness() = default;

void Witness::listen() {
  const std::stop_token stop = thread_.get_stop_token();
  while (!stop.stop_requested()) {
    pollfd socket{.fd = bus_.descriptor(), .events = POLLIN, .revents = 0};
    (void)::poll(&socket, 1, 20);
    const std::lock_guard lock(mutex_);
    while (const auto frame = bus_.poll()) frames_.push_back(*frame);
    const std::uint64_t errors = bus_.health().counts.error_frames;
    if (errors != std::exchange(errors_, errors)) last_error_ = monotonic_now();
  }
}

std::optional<StampedCanFrame> Witness::wait_for(const Question& question, Stamp since,
                                                 Duration longest) const {
  const Stamp end = monotonic_now() + longest;
  while (true) {
    const auto found = heard(question, since);
    if (!found.empty()) return found.front();
    if (monotonic_now() >= end) return std::nullopt;
    std::this_thread::sleep_for(5ms);
  }
}

std::vector<StampedCanFrame> Witness::heard(const Question& question, Stamp since, Stamp until) const {
  const std::lock_guard lock(mutex_);
  std::vector<StampedCanFrame> found;
  std::ranges::copy_if(frames_, std::back_inserter(found), [&](const StampedCanFrame& frame) {
    return frame.stamp > since && frame.stamp <= until && question(frame.frame);
  });
  return found;
}

std::optional<Stamp> Witness::last(const Question& question, Stamp until) const {
  const auto found = heard(question, Stamp{}, until);
  return found.empty() ? std::nullopt : std::optional(found.back().stamp);
}

std::optional<Stamp> Witness::last_error() const {
  const std::lock_guard lock(mutex_);
  return last_error_;
}

bool is_anything(const CanFrame& /*frame*/) {
  return true;
}

bool is_motion_command(const CanFrame& frame) {
  return agilex::decode_motion_command(frame).has_value();
}

bool is_zero_command(const CanFrame& frame) {
  const auto velocity = agilex::decode_motion_command(frame);
  return velocity && velocity->forward_mps == 0.0 && velocity->turn_radps == 0.0;
}

bool is_moving_command(const CanFrame& frame) {
  return is_motion_command(frame) && !is_zero_command(frame);
}

Witness::Question drives_faster_than(double forward_mps) {
  return [forward_mps](const CanFrame& frame) {
    const auto velocity = agilex::decode_motion_state(frame);
    return velocity && velocity->forward_mps > forward_mps;
  };
}

bool says_standing(const CanFrame& frame) {
  const auto velocity = agilex::decode_motion_state(frame);
  return velocity && std::abs(velocity->forward_mps) < 0.005 && std::abs(velocity->turn_radps) < 0.02;
}

}  // namespace lodestar
