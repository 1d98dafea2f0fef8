#pragma once

#include <deque>
#include <gtest/gtest.h>
#include <vector>

#include "drivers/base/base_driver.hpp"

// A base driver on a scripted bus with a scripted base.
namespace lodestar::testing {

/// A bus that the test feeds and reads.
class ScriptedBus final : public CanBus {
 public:
  bool send(const CanFrame& frame) override {
    if (!takes_frames) return false;
    sent.push_back(frame);
    return true;
  }
  std::optional<StampedCanFrame> poll() override {
    if (arriving.empty()) return std::nullopt;
    const StampedCanFrame frame = arriving.front();
    arriving.pop_front();
    return frame;
  }

  [[nodiscard]] BusHealth health() const override { return {state, {}}; }
  void resume() override { ++resumes; }
  void release() override { ++releases; }

  bool takes_frames = true;
  BusState state = BusState::up;
  int resumes = 0;
  int releases = 0;
  std::vector<CanFrame> sent;
  std::deque<StampedCanFrame> arriving;
};

/// A driver, and a base that sends the test's values every 20 ms.
class BaseDriverTest : public ::testing::Test {
 protected:
  void hear(const CanFrame& frame) { bus.arriving.push_back({now, frame}); }

  void base_speaks() {
    if (!base_silent) {
      hear(agilex::encode_system_state(system));
      if (counter_runs) ++system.counter;
      hear(agilex::encode_motion_state(measured));
      hear(agilex::encode_odometer(odometer));
    }
  }

  BaseFeedback period() {
    now += std::chrono::milliseconds(20);
    base_speaks();
    return driver.poll(now);
  }

  BaseFeedback periods(int count) {
    BaseFeedback feedback;
    for (int i = 0; i < count; ++i) feedback = period();
    return feedback;
  }

  void make_ready() {
    system.mode = agilex::ControlMode::can;
    ASSERT_EQ(period().state, BaseState::ready);
    bus.sent.clear();
  }

  /// Until the base latches as one that does not follow this command, whatever it measures.
  int periods_until_not_following(const BodyVelocity& commanded) {
    BaseFeedback feedback;
    int count = 0;
    for (; feedback.state != BaseState::fault && count < 200; ++count) {
      driver.command(commanded);
      feedback = period();
    }
    EXPECT_EQ(feedback.fault, BaseFault::not_following);
    return count;
  }

  void expect_latched(BaseFault fault, const BaseFeedback& feedback) {
    EXPECT_EQ(feedback.state, BaseState::fault);
    EXPECT_EQ(feedback.fault, fault) << to_string(feedback.fault.value_or(BaseFault::send_failed));
    bus.sent.clear();
    driver.command({0.5, 0.0});
    EXPECT_TRUE(bus.sent.empty()) << "commands motion despite the fault";
  }

  ScriptedBus bus;
  BaseDriver driver{bus};
  Stamp now;
  agilex::SystemState system;
  BodyVelocity measured;
  agilex::Odometer odometer;
  bool base_silent = false;
  bool counter_runs = true;
};

}  // namespace lodestar::testing
