#include "drivers/base/base_driver.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lodestar {
namespace {

bool is_older(const std::optional<Stamp>& stamp, Stamp now, Duration age) {
  return !stamp || now - *stamp > age;
}

}  // namespace

std::string_view to_string(BaseState state) {
  switch (state) {
    case BaseState::waiting_for_base:
      return "waiting for the base";
    case BaseState::asking_for_can_mode:
      return "asking the base for CAN mode";
    case BaseState::ready:
      return "ready";
    case BaseState::fault:
      return "stopped by a fault";
  }
  return "in an unknown state";
}

std::string_view to_string(BaseFault fault) {
  switch (fault) {
    case BaseFault::feedback_lost:
      return "the base is silent";
    case BaseFault::feedback_incomplete:
      return "the base does not send all of its feedback";
    case BaseFault::counter_stuck:
      return "the counter in the base's state stands still";
    case BaseFault::left_can_mode:
      return "the base is not in CAN mode";
    case BaseFault::emergency_stop:
      return "the emergency stop is pressed";
    case BaseFault::vehicle_exception:
      return "the base reports an exception";
    case BaseFault::fault_bits:
      return "the base reports fault bits";
    case BaseFault::not_following:
      return "the base does not follow its commands";
    case BaseFault::second_master:
      return "somebody else sends motion commands";
    case BaseFault::send_failed:
      return "commands cannot be sent";
    case BaseFault::bus_stalled:
      return "the CAN bus takes no frames any more";
    case BaseFault::bus_off:
      return "the CAN controller is bus-off";
    case BaseFault::bus_down:
      return "the CAN interface is switched off";
    case BaseFault::bus_missing:
      return "the CAN interface is missing";
    case BaseFault::guard_stopped:
      return "the guard has stopped a navigator that hung";
    case BaseFault::guard_lost:
      return "the guard process is gone";
  }
  return "an unknown fault";
}

bool is_reported_by_base(BaseFault fault) {
  return fault == BaseFault::emergency_stop || fault == BaseFault::vehicle_exception ||
         fault == BaseFault::fault_bits;
}

std::string in_words(BaseFault fault, const std::string& details) {
  return details.empty() ? std::string(to_string(fault)) : fmt::format("{}: {}", to_string(fault), details);
}

BaseDriver::BaseDriver(CanBus& bus, const BaseDriverOptions& options)
    : BaseDriver(bus, make_agilex_protocol(), options) {}

BaseDriver::BaseDriver(CanBus& bus, std::unique_ptr<BaseProtocol> protocol, const BaseDriverOptions& options)
    : bus_(bus), protocol_(std::move(protocol)), options_(options), following_(options.following) {}

BaseFeedback BaseDriver::poll(Stamp now) {
  // After a pause of this process, frames that the base sent meanwhile may not have been read yet.
  const bool was_asleep = now - now_ > options_.max_feedback_age;
  now_ = now;
  std::vector<WheelTravel> travel;
  while (const auto received = bus_.poll()) handle(*received, travel);
  if (const auto fault = bus_fault(); fault && state_ == BaseState::ready) latch(*fault);
  if (state_ == BaseState::ready) {
    if (!was_asleep) watch(now);
  } else if (state_ != BaseState::fault) {
    shake_hands(now);
  }
  return {state_, fault_, details_, std::move(travel), measured_, system_, last_heard_};
}

void BaseDriver::handle(const StampedCanFrame& received, std::vector<WheelTravel>& travel) {
  const HeardFrame heard = protocol_->decode(received);
  if (heard.odd) ++counts_.odd_frames;
  if (heard.command && state_ == BaseState::ready) latch(BaseFault::second_master);
  if (!heard.from_base) return;
  if (is_older(last_heard_, received.stamp, options_.max_feedback_age)) heard_since_ = received.stamp;
  last_heard_ = received.stamp;
  if (heard.system) update_system_state(received.stamp, *heard.system);
  if (heard.measured) {
    measured_ = heard.measured;
    last_motion_state_ = received.stamp;
  }
  if (heard.travel) {
    travel.push_back(*heard.travel);
    last_odometer_ = received.stamp;
  }
}

/// The first state counts as alive, until a second one repeats its counter.
void BaseDriver::update_system_state(Stamp stamp, const SystemState& state) {
  const int steps = system_ ? static_cast<std::uint8_t>(state.counter - system_->counter) : 1;
  if (steps == 0) ++counts_.counter_repeats;
  if (steps > 1) ++counts_.counter_jumps;
  if (steps != 0) {
    counter_has_advanced_ = system_.has_value();
    last_alive_ = stamp;
  } else if (!counter_has_advanced_) {
    last_alive_.reset();
  }
  last_state_ = stamp;
  system_ = state;

  if (state_ != BaseState::ready) return;
  if (const auto fault = system_fault(state)) latch(*fault);
}

/// Faults of a ready base that show by elapsed time; those that its frames report are latched on arrival.
void BaseDriver::watch(Stamp now) {
  if (const auto fault = feedback_fault(now)) return latch(*fault);
  const bool command_is_valid = !is_older(commanded_at_, now, options_.base_command_timeout);
  const BodyVelocity expected = command_is_valid ? commanded_ : BodyVelocity{};
  if (following_.strays(now, expected, *measured_)) latch(BaseFault::not_following);
}

void BaseDriver::shake_hands(Stamp now) {
  state_ = BaseState::waiting_for_base;
  std::optional<BaseFault> missing = bus_fault();
  if (!missing) missing = state_fault(now);
  if (!missing) missing = system_fault(*system_);
  if (!missing) missing = feedback_fault(now);
  if (missing == BaseFault::feedback_incomplete) incomplete_at_ = now;
  // One message of a kind that comes too rarely does not make a base that can be watched: the next must come.
  const bool came_just_now = incomplete_at_ && now - *incomplete_at_ <= 2 * options_.max_kind_age;
  if (came_just_now && (!missing || missing == BaseFault::left_can_mode)) return;
  set_fault(missing);
  if (!fault_) {
    state_ = BaseState::ready;
    commanded_at_.reset();
    following_.restart(now, *measured_);
  } else if (fault_ == BaseFault::left_can_mode) {
    state_ = BaseState::asking_for_can_mode;
    if (asked_at_ && now - *asked_at_ < options_.handshake_period) return;
    asked_at_ = now;
    send(protocol_->enable());
  }
}

void BaseDriver::latch(BaseFault fault) {
  state_ = BaseState::fault;
  set_fault(fault);
  // Send a final stop, but not to a base that another controller has taken over.
  if (fault == BaseFault::left_can_mode) return bus_.release();
  send(protocol_->stop());
}

void BaseDriver::set_fault(const std::optional<BaseFault>& fault) {
  fault_ = fault;
  details_ = fault ? details_of(*fault) : std::string();
}

void BaseDriver::command(const BodyVelocity& velocity) {
  if (state_ != BaseState::ready) return;
  commanded_ = within_limits(velocity);
  commanded_at_ = now_;
  if (send(protocol_->command(commanded_))) return;
  if (failed_sends_in_a_row_ >= options_.max_failed_sends) latch(BaseFault::send_failed);
}

BodyVelocity BaseDriver::within_limits(const BodyVelocity& velocity) {
  if (!std::isfinite(velocity.forward_mps) || !std::isfinite(velocity.turn_radps)) {
    ++counts_.non_finite_commands;
    return {};
  }
  const double share = bus_.health().state == BusState::error_passive ? options_.error_passive_share : 1.0;
  const double faster_wheel_mps =
      std::abs(velocity.forward_mps) + std::abs(velocity.turn_radps) * options_.track_width_m / 2.0;
  const double excess = std::max({std::abs(velocity.forward_mps) / (share * options_.max_forward_mps),
                                  std::abs(velocity.turn_radps) / (share * options_.max_turn_radps),
                                  faster_wheel_mps / (share * options_.max_wheel_mps)});
  if (excess <= 1.0) return velocity;
  ++counts_.saturated_commands;
  return {velocity.forward_mps / excess, velocity.turn_radps / excess};
}

bool BaseDriver::send(const std::vector<CanFrame>& frames) {
  bool sent = true;
  for (const CanFrame& frame : frames) sent = bus_.send(frame) && sent;
  failed_sends_in_a_row_ = sent ? 0 : failed_sends_in_a_row_ + 1;
  if (!sent) ++counts_.failed_sends;
  return sent;
}

bool BaseDriver::resume(Stamp now) {
  if (state_ == BaseState::waiting_for_base && fault_)
    return is_reported_by_base(*fault_) && send(protocol_->clear_faults());
  if (state_ != BaseState::fault) return true;
  const BusState bus = bus_.health().state;
  if (feedback_fault(now) || (bus_fault() && bus != BusState::held)) return false;
  const auto still = system_fault(*system_);
  const bool is_in_standby = still == BaseFault::left_can_mode && system_->mode == ControlMode::standby;
  if (still && still != BaseFault::left_can_mode) send(protocol_->clear_faults());
  if (still && !is_in_standby) return false;
  if (bus == BusState::held) bus_.resume();
  state_ = BaseState::waiting_for_base;
  set_fault(std::nullopt);
  failed_sends_in_a_row_ = 0;
  return true;
}

std::vector<std::string> BaseDriver::warnings() const {
  if (!system_) return {};
  return protocol_->fault_names(system_->fault_bits & ~stopping_bits(*system_));
}

/// What is wrong with the stream of system states, apart from what they say.
std::optional<BaseFault> BaseDriver::state_fault(Stamp now) const {
  if (is_older(last_heard_, now, options_.max_feedback_age)) return BaseFault::feedback_lost;
  if (is_older(last_state_, now, options_.max_kind_age)) {
    const bool may_still_come = now - *heard_since_ <= options_.max_kind_age;
    return may_still_come ? BaseFault::feedback_lost : BaseFault::feedback_incomplete;
  }
  if (is_older(last_alive_, now, options_.max_kind_age)) return BaseFault::counter_stuck;
  return std::nullopt;
}

std::optional<BaseFault> BaseDriver::feedback_fault(Stamp now) const {
  if (const auto fault = state_fault(now)) return fault;
  const bool has_all = !is_older(last_motion_state_, now, options_.max_kind_age) &&
                       !is_older(last_odometer_, now, options_.max_kind_age);
  if (has_all) return std::nullopt;
  const bool may_still_come = now - *heard_since_ <= options_.max_kind_age;
  return may_still_come ? BaseFault::feedback_lost : BaseFault::feedback_incomplete;
}

std::string BaseDriver::details_of(BaseFault fault) const {
  if ((fault == BaseFault::fault_bits || fault == BaseFault::vehicle_exception) && system_)
    return fmt::format("{}", fmt::join(protocol_->fault_names(stopping_bits(*system_)), ", "));
  if (fault != BaseFault::feedback_incomplete) return {};
  std::vector<std::string_view> missing;
  if (is_older(last_state_, now_, options_.max_kind_age)) missing.emplace_back("no system state");
  if (is_older(last_motion_state_, now_, options_.max_kind_age)) missing.emplace_back("no motion state");
  if (is_older(last_odometer_, now_, options_.max_kind_age)) missing.emplace_back("no odometer");
  return fmt::format("{}", fmt::join(missing, ", "));
}

std::uint32_t BaseDriver::stopping_bits(const SystemState& state) const {
  return state.fault_bits & ~(options_.ignored_fault_bits | protocol_->warning_bits());
}

std::optional<BaseFault> BaseDriver::system_fault(const SystemState& state) const {
  if (state.vehicle == VehicleState::emergency_stop) return BaseFault::emergency_stop;
  if (state.vehicle != VehicleState::normal) return BaseFault::vehicle_exception;
  if (stopping_bits(state) != 0) return BaseFault::fault_bits;
  if (state.mode != ControlMode::can) return BaseFault::left_can_mode;
  return std::nullopt;
}

std::optional<BaseFault> BaseDriver::bus_fault() const {
  switch (bus_.health().state) {
    case BusState::up:
    case BusState::error_passive:
      return std::nullopt;
    case BusState::stalled:
      return BaseFault::bus_stalled;
    case BusState::bus_off:
      return BaseFault::bus_off;
    case BusState::down:
      return BaseFault::bus_down;
    case BusState::missing:
      return BaseFault::bus_missing;
    case BusState::held:
      return BaseFault::guard_stopped;
    case BusState::guard_lost:
      return BaseFault::guard_lost;
  }
  return BaseFault::bus_missing;
}

}  // namespace lodestar
