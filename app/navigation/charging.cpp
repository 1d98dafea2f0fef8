#include "app/navigation/charging.hpp"

#include <fmt/format.h>

namespace lodestar {

std::string_view to_string(ChargingState state) {
  switch (state) {
    case ChargingState::none:
      return "";
    case ChargingState::driving:
      return "on the way to the dock";
    case ChargingState::connecting:
      return "waiting for the charger";
    case ChargingState::charging:
      return "charging";
    case ChargingState::full:
      return "charged";
  }
  return "";
}

Charging::Charging(ChargingSettings settings, std::function<void(const std::string&)> tell,
                   const ChargingOptions& options)
    : settings_(std::move(settings)), tell_(std::move(tell)), options_(options) {}

std::vector<Goal> Charging::goals() const {
  const Pose2 before = approach_pose(settings_);
  const Pose2& dock = settings_.map_from_dock;
  return {{.position_m = before.position_m, .heading_rad = before.yaw_rad},
          {.position_m = dock.position_m,
           .heading_rad = dock.yaw_rad,
           .max_mps = settings_.approach_mps,
           .on_line = true}};
}

void Charging::begin(Mission& mission) {
  if (mission.finished()) {
    mission.start(goals());
  } else {
    mission.append(goals());
  }
  expect(mission.goals().size() - 1);
}

void Charging::expect(std::size_t dock) {
  dock_ = dock;
  failure_.clear();
  enter(ChargingState::driving, "to " + settings_.place);
}

void Charging::end() {
  if (state_ != ChargingState::none && state_ != ChargingState::driving) enter(ChargingState::none, "ended");
}

void Charging::watch(Stamp now, const BaseFeedback& base, const MissionStep& step, Mission& mission) {
  now_ = now;
  if (base.system) battery_v_ = base.system->battery_v;
  const bool has_left = !mission.finished() || mission.phase() == MissionPhase::by_hand;
  if (state_ == ChargingState::driving) {
    watch_drive(step, mission);
  } else if (state_ != ChargingState::none && has_left) {
    enter(ChargingState::none, "off the dock");
  } else if (state_ == ChargingState::connecting) {
    watch_contacts();
  } else if (state_ == ChargingState::charging) {
    watch_charge();
  } else {
    watch_level(base, mission);
  }
}

void Charging::watch_drive(const MissionStep& step, Mission& mission) {
  if (mission.phase() == MissionPhase::settling && mission.current() < dock_) rest_v_ = battery_v_;
  if (step.event == MissionEvent::goal_failed && mission.current() >= dock_) {
    fail(mission.failure());
  } else if (!mission.finished() && mission.current() > dock_) {
    enter(ChargingState::none, "driven on");
  } else if (mission.finished()) {
    if (step.event != MissionEvent::goal_arrived || mission.current() != dock_ + 1)
      return fail(mission.failure());
    enter(ChargingState::connecting, fmt::format("on the dock, {:.1f} V before it", rest_v_));
  }
}

void Charging::watch_contacts() {
  if (has_lasted(battery_v_ >= rest_v_ + settings_.rise_v, options_.confirm))
    return enter(ChargingState::charging, fmt::format("{:.1f} V, charging", battery_v_));
  if (now_ - entered_ < options_.max_connecting) return;
  fail(battery_v_ > 0.0
           ? fmt::format("{:.1f} V on the dock, {:.1f} V before it: it does not charge", battery_v_, rest_v_)
           : "the base does not report the battery's voltage");
}

void Charging::watch_charge() {
  if (battery_v_ >= settings_.full_v) {
    if (has_lasted(true, options_.confirm))
      enter(ChargingState::full, fmt::format("{:.1f} V, charged", battery_v_));
  } else if (has_lasted(battery_v_ < rest_v_ + settings_.rise_v / 2.0, options_.confirm)) {
    fail(fmt::format("charging ended at {:.1f} V", battery_v_));
  }
}

void Charging::watch_level(const BaseFeedback& base, Mission& mission) {
  const bool is_idle = mission.phase() == MissionPhase::idle && base.state == BaseState::ready;
  if (!is_idle) {
    idle_since_.reset();
    if (!mission.finished()) goes_by_itself_ = true;
    return;
  }
  if (!idle_since_) idle_since_ = now_;
  const bool is_low = settings_.low_v && battery_v_ > 0.0 && battery_v_ <= *settings_.low_v;
  if (!is_low || !goes_by_itself_ || now_ - *idle_since_ < options_.idle) return;
  if (tell_) tell_(fmt::format("charging: {:.1f} V, it goes by itself", battery_v_));
  begin(mission);
}

/// Asked in one state about two things that exclude each other, or about one.
bool Charging::has_lasted(bool holds, Duration how_long) {
  if (!holds) {
    holds_since_.reset();
    return false;
  }
  if (!holds_since_) holds_since_ = now_;
  return now_ - *holds_since_ >= how_long;
}

void Charging::enter(ChargingState state, const std::string& words) {
  state_ = state;
  entered_ = now_;
  holds_since_.reset();
  idle_since_.reset();
  if (tell_) tell_("charging: " + words);
}

void Charging::fail(const std::string& why) {
  failure_ = why;
  goes_by_itself_ = false;
  enter(ChargingState::none, why);
}

}  // namespace lodestar
