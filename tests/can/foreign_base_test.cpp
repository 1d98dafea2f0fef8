#include <cmath>

#include "tests/can/lab.hpp"

// A base that is not ours, written from the protocol's description in another language, with the quirks of
// real ones: the navigator arrives, or says in one sentence why not.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

constexpr Duration start_up = 20s;  ///< of both programs on a busy machine

class ForeignBase : public CanLab {
 protected:
  void start_foreign_base(std::vector<std::string> quirks) {
    std::vector<std::string> words{"/usr/bin/python3", LODESTAR_SOURCE_DIR "/tests/can/foreign_base.py",
                                   base_end};
    words.insert(words.end(), quirks.begin(), quirks.end());
    base = std::make_unique<Process>(std::move(words));
    ASSERT_TRUE(witness->wait_for([](const CanFrame& frame) { return frame.id == agilex::motion_state_id; },
                                  Stamp{}, start_up))
        << "the base never sent a frame";
  }

  void expect_arrival(const std::vector<std::string>& quirks) {
    start_foreign_base(quirks);
    start_run("--goal 1.8,5.55");
    expect_to_arrive();
  }

  void expect_to_arrive() {
    EXPECT_EQ(wait_for_the_end(60s), 0);
    const Truth truth = end_base();
    EXPECT_NEAR(truth.x_m, 1.8, 0.03);
    EXPECT_NEAR(truth.y_m, 5.55, 0.03);
  }

  /// The reason comes first in the message, in these words.
  void expect_refusal(const std::vector<std::string>& quirks, const std::string& reason) {
    start_foreign_base(quirks);
    start_run("--goal 1.8,5.55");
    EXPECT_TRUE(wait_for_words(reason, start_up)) << run->output();
    EXPECT_FALSE(witness->wait_for(is_moving_command, Stamp{}, 2s)) << "motion commanded nevertheless";
  }
};

TEST_F(ForeignBase, without_quirks_is_driven) {
  expect_arrival({});
}

TEST_F(ForeignBase, that_grants_can_mode_late_is_asked_until_it_does) {
  expect_arrival({"--grants-can-after", "3"});
  const auto is_request = [](const CanFrame& frame) { return frame.id == agilex::control_mode_id; };
  EXPECT_GT(witness->heard(is_request, Stamp{}).size(), 20U);
}

TEST_F(ForeignBase, whose_remote_control_drives_first_is_waited_for) {
  start_foreign_base({"--remote-first", "8"});
  start_run("--goal 1.8,5.55");
  EXPECT_TRUE(wait_for_words("the base is not in CAN mode", start_up));
  const auto granted = witness->wait_for(
      [](const CanFrame& frame) {
        const auto state = agilex::decode_system_state(frame);
        return state && state->mode == ControlMode::can;
      },
      Stamp{}, start_up);
  ASSERT_TRUE(granted);
  EXPECT_TRUE(witness->heard(is_motion_command, Stamp{}, granted->stamp).empty());
  expect_to_arrive();
}

TEST_F(ForeignBase, whose_measured_speed_is_noisy_at_rest_is_driven) {
  expect_arrival({"--noise-at-rest", "0.005"});
}

TEST_F(ForeignBase, that_reports_its_state_ten_times_a_second_is_driven) {
  expect_arrival({"--state-period", "0.1"});
}

TEST_F(ForeignBase, that_reports_its_state_too_rarely_is_refused) {
  expect_refusal({"--state-period", "0.8"}, "the base does not send all of its feedback: no system state");
}

TEST_F(ForeignBase, without_an_odometer_is_refused) {
  expect_refusal({"--no-odometer"}, "the base does not send all of its feedback: no odometer");
}

TEST_F(ForeignBase, whose_counter_has_four_bits_is_driven) {
  expect_arrival({"--counter-values", "16"});
}

TEST_F(ForeignBase, whose_counter_stands_still_is_refused_and_diagnosed) {
  expect_refusal({"--counter-values", "1"}, "the counter in the base's state stands still");
  const auto named = run->said("the counter in the base's state stands still");
  EXPECT_FALSE(run->said("the base is silent", named.value_or(Stamp{}))) << run->output();
  Process doctor({LODESTAR_BINARY, "doctor", site, "--can", navigator_end});
  EXPECT_EQ(doctor.wait(40s), 1);
  EXPECT_NE(doctor.output().find("stands still at 0"), std::string::npos) << doctor.output();
}

TEST_F(ForeignBase, with_unequal_wheels_is_driven) {
  expect_arrival({"--right-wheel", "1.03"});
}

TEST_F(ForeignBase, that_obeys_late_is_driven) {
  expect_arrival({"--dead-time", "0.1"});
}

TEST_F(ForeignBase, with_its_transmitter_off_and_a_low_battery_is_driven) {
  expect_arrival({"--fault-bits", "0600"});
  EXPECT_TRUE(run->said("reports battery under-voltage warning, remote control lost")) << run->output();
}

TEST_F(ForeignBase, with_a_fault_is_driven_once_it_was_told_to_clear_it) {
  start_foreign_base({"--fault-bits", "0100"});
  start_run("--goal 1.8,5.55");
  EXPECT_TRUE(wait_for_words("the base reports fault bits: battery under-voltage", start_up));
  EXPECT_FALSE(witness->wait_for(is_moving_command, Stamp{}, 500ms));
  run->say("resume");
  expect_to_arrive();
}

}  // namespace
}  // namespace lodestar
